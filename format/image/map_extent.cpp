#include "map_extent.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace drtv::image {
namespace {

constexpr double usual_side_px = 1600;
constexpr double max_side_px = 7168;

std::size_t pixels_of(int sectors, double metres_per_pixel) {
    const double pixels = std::round(sectors * double{sector_size_m} / metres_per_pixel);
    return static_cast<std::size_t>(std::max(1.0, pixels));
}

// "0.05"
std::string number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.4g", value);
    return text.data();
}

}  // namespace

MapExtent measure(std::span<const std::array<std::int32_t, 2>> sectors, double metres_per_pixel) {
    const auto [first_i, first_j] = sectors.front();
    MapExtent e{first_i, first_j, first_i + 1, first_j + 1, metres_per_pixel, 0, 0, ""};
    for (const auto& [i, j] : sectors) {
        e.i0 = std::min(e.i0, i);
        e.j0 = std::min(e.j0, j);
        e.i1 = std::max(e.i1, i + 1);
        e.j1 = std::max(e.j1, j + 1);
    }
    const double side_m = std::max(e.i1 - e.i0, e.j1 - e.j0) * double{sector_size_m};
    if (metres_per_pixel <= 0)
        e.metres_per_pixel = side_m / usual_side_px;
    const double finest = side_m / max_side_px;
    if (e.metres_per_pixel < finest) {
        e.note = number(e.metres_per_pixel) + " m a pixel would make " +
                 number(std::round(side_m / e.metres_per_pixel)) + " pixels a side; the map is drawn at " +
                 number(finest) + " m a pixel, for the limit is 8,192 with the frame";
        e.metres_per_pixel = finest;
    }
    e.width = pixels_of(e.i1 - e.i0, e.metres_per_pixel);
    e.height = pixels_of(e.j1 - e.j0, e.metres_per_pixel);
    return e;
}

}  // namespace drtv::image
