#include "bakerd/picture/film.h"

#include "format/kit/srgb.h"

#include <glm/common.hpp>

#include <cmath>

namespace drtv::picture {

float exposure_of(float ev) {
    return static_cast<float>(std::exp2(static_cast<double>(ev)));
}

glm::vec3 filmic(const glm::vec3& exposed) {
    const glm::vec3 x = glm::max(exposed, glm::vec3(0));
    const glm::vec3 bright = x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
    // What is not a number, infinity over infinity, is white.
    return {bright.x < 1 ? bright.x : 1, bright.y < 1 ? bright.y : 1, bright.z < 1 ? bright.z : 1};
}

void put_pixel(kit::Image& image, std::size_t x, std::size_t y, const glm::vec3& linear) {
    std::uint8_t* pixel = image.at(x, y);
    for (glm::length_t c = 0; c < 3; ++c)
        pixel[c] = kit::encode_srgb(linear[c]);
}

float ev_for(float mean) {
    constexpr double middle = 0.32;
    constexpr double steps = 4;
    return static_cast<float>(std::floor(std::log2(middle / static_cast<double>(mean)) * steps + 0.5) /
                              steps);
}

}  // namespace drtv::picture
