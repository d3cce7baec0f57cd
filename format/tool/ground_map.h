// The ground of a region as its probes tell it: height and sky visibility under each pixel of a picture.
#pragma once

#include "map_extent.h"
#include "region_picture.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace drtv::tool {

struct Ground {
    float weight = 0;  // 0 where every probe is too far away
    float height_m = 0;
    float sky_visibility = 0;
};

class GroundMap {
  public:
    // Looks at `dots` only here.
    GroundMap(const MapExtent& extent, const std::vector<Dot>& dots);

    // Beyond the last column or row, that of the last pixel.
    [[nodiscard]] const Ground& at(std::size_t x, std::size_t y) const {
        const std::size_t column = std::min(x, width_ - 1);
        const std::size_t row = std::min(y, height_ - 1);
        return ground_[row * width_ + column];
    }

    // Lambert shading from the north-west, as relief maps are drawn. REQUIRES: there is ground.
    [[nodiscard]] float shade(std::size_t x, std::size_t y) const;

  private:
    std::size_t width_;
    std::size_t height_;
    float run_m_;  // from one pixel to the next
    std::vector<Ground> ground_;
};

}  // namespace drtv::tool
