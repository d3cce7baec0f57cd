#include "srgb.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace drtv::kit {
namespace {

// From a code, which may lie between two. The C library's pow differs between machines in its last digit.
double linear_from(double code) {
    const double c = code / 255;
    if (c <= 0.04045)
        return c / 12.92;
    const double x = (c + 0.055) / 1.055;
    double root = 1;  // of x^2, the fifth: by Newton's method, from above
    for (int n = 0; n < 60; ++n)
        root -= (root - x * x / (root * root * root * root)) / 5;
    return x * x * root;
}

// [k]: from here on the code is above k.
std::array<float, 255> make_limits() {
    std::array<float, 255> limits{};
    for (std::size_t k = 0; k < limits.size(); ++k)
        limits[k] = static_cast<float>(linear_from(static_cast<double>(k) + 0.5));
    return limits;
}

}  // namespace

std::uint8_t encode_srgb(float linear) {
    static const std::array<float, 255> limits = make_limits();
    if (std::isnan(linear))
        return 0;
    return static_cast<std::uint8_t>(std::upper_bound(limits.begin(), limits.end(), linear) - limits.begin());
}

}  // namespace drtv::kit
