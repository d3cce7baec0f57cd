#include "bakerd/picture/film.h"

#include "format/kit/srgb.h"

#include <glm/common.hpp>

#include <array>
#include <cmath>
#include <numbers>

namespace drtv::picture {

// By quarters as far as they go: these are the same on every machine.
float exposure_of(float ev) {
    constexpr std::array<double, 4> quarters = {
        1, 1.189207115002721, 1.4142135623730951, 1.681792830507429};  // 2^(n/4)
    const double whole = std::floor(static_cast<double>(ev) * 4);
    const double rest = static_cast<double>(ev) - whole / 4;
    const auto quarter = static_cast<int>(whole);
    const double of_quarters = std::ldexp(quarters[static_cast<std::size_t>(quarter & 3)], quarter >> 2);
    return static_cast<float>(rest == 0 ? of_quarters : of_quarters * std::exp2(rest));
}

glm::vec3 filmic(const glm::vec3& exposed) {
    const glm::vec3 x = glm::max(exposed, glm::vec3(0));
    const glm::vec3 bright = x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
    // What is not a number, infinity over infinity, is white.
    return {bright.x < 1 ? bright.x : 1, bright.y < 1 ? bright.y : 1, bright.z < 1 ? bright.z : 1};
}

void put_pixel(image::Image& image, std::size_t x, std::size_t y, const glm::vec3& linear) {
    std::uint8_t* pixel = image.at(x, y);
    for (glm::length_t c = 0; c < 3; ++c)
        pixel[c] = kit::encode_srgb(linear[c]);
}

float ev_for(double brightness_log2) {
    constexpr double middle_log2 = -1.65;  // 0.32
    constexpr double steps = 4;
    return static_cast<float>(std::floor((middle_log2 - brightness_log2) * steps + 0.5) / steps);
}

// 2 atanh((m - 1) / (m + 1)) for the mantissa.
double log2_of(double value) {
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);  // 1/2 to 1
    const double z = (mantissa - 1) / (mantissa + 1);      // down to -1/3
    double sum = 0;
    double power = z;
    for (int n = 1; n < 40; n += 2) {
        sum += power / n;
        power *= z * z;
    }
    return exponent + sum * (2 * std::numbers::log2e);
}

}  // namespace drtv::picture
