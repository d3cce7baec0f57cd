// The ground of a region as its probes tell it: height and sky visibility under each pixel of a picture.
#pragma once

#include "image/map_extent.h"
#include "region_picture.h"

#include <cstddef>
#include <vector>

namespace drtv::tool {

struct Ground {
    float weight = 0;  // 0 where every probe is too far away
    float height_m = 0;
    float sky_visibility = 0;
};

// Probes by squares, so that a pixel looks at its surroundings only.
class ProbeSquares {
  public:
    ProbeSquares(const image::MapExtent& extent, const std::vector<Dot>& dots);

    [[nodiscard]] Ground ground_at(double x_m, double y_m) const;

  private:
    [[nodiscard]] std::size_t column_of(double x_m) const;
    [[nodiscard]] std::size_t row_of(double y_m) const;

    double x0_m_;
    double y0_m_;
    double side_m_;  // of a square
    std::size_t reach_;
    std::size_t columns_;
    std::size_t rows_;
    std::vector<std::vector<const Dot*>> squares_;
};

// Goes through a picture from row to row, for a large one would not fit into memory.
class GroundRows {
  public:
    // At row 0. REQUIRES: both outlive it.
    GroundRows(const image::MapExtent& extent, const std::vector<Dot>& dots);

    void next_row();

    // Beyond the last column, that of the last pixel.
    [[nodiscard]] const Ground& at(std::size_t x) const;
    // Lambert shading from the north-west, as relief maps are drawn. REQUIRES: there is ground.
    [[nodiscard]] float shade(std::size_t x) const;

  private:
    [[nodiscard]] std::vector<Ground> row(std::size_t y) const;

    const image::MapExtent& extent_;
    const ProbeSquares squares_;
    std::size_t y_ = 0;
    std::vector<Ground> here_;
    std::vector<Ground> south_;  // of the next row; of the last row its own
};

}  // namespace drtv::tool
