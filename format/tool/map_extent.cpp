#include "map_extent.h"

#include <drtv/conventions.h>

#include <algorithm>
#include <cmath>

namespace drtv::tool {
namespace {

std::size_t pixels_of(int sectors, double metres_per_pixel) {
    const double pixels = std::round(sectors * sector_size_m / metres_per_pixel);
    return static_cast<std::size_t>(std::max(1.0, pixels));
}

}  // namespace

MapExtent measure(std::span<const std::array<std::int32_t, 2>> sectors, double metres_per_pixel) {
    const auto [first_i, first_j] = sectors.front();
    MapExtent e{first_i, first_j, first_i + 1, first_j + 1, metres_per_pixel, 0, 0};
    for (const auto& [i, j] : sectors) {
        e.i0 = std::min(e.i0, i);
        e.j0 = std::min(e.j0, j);
        e.i1 = std::max(e.i1, i + 1);
        e.j1 = std::max(e.j1, j + 1);
    }
    const int longer = std::max(e.i1 - e.i0, e.j1 - e.j0);
    const double side_m = longer * double{sector_size_m};
    if (metres_per_pixel <= 0)
        e.metres_per_pixel = side_m / 1600;
    e.metres_per_pixel = std::max(e.metres_per_pixel, side_m / 8000);
    e.width = pixels_of(e.i1 - e.i0, e.metres_per_pixel);
    e.height = pixels_of(e.j1 - e.j0, e.metres_per_pixel);
    return e;
}

}  // namespace drtv::tool
