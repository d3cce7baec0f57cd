#include "bakerd/map/texel.h"

#include <cmath>

namespace drtv::map {
namespace {

double linear_of(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// Correctly rounded from double, so that the last bit of pow does not show.
std::array<float, 256> make_linear_from_srgb() {
    std::array<float, 256> table{};
    for (std::size_t n = 0; n < table.size(); ++n) {
        const double encoded = static_cast<double>(n) / 255;
        table[n] = static_cast<float>(linear_of(encoded));
    }
    return table;
}

}  // namespace

const std::array<float, 256> linear_from_srgb = make_linear_from_srgb();

}  // namespace drtv::map
