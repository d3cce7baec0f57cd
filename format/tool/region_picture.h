// A region of sectors from above: probes as dots over a shaded map of sky visibility.
#pragma once

#include "dot_colour.h"
#include "png_writer.h"

#include <drtv/sector.h>

#include <cstddef>
#include <vector>

namespace drtv::tool {

struct PictureOptions {
    double metres_per_pixel = 0;  // 0: so that the longer side has about 1,600 pixels
    DotQuantity dots = DotQuantity::relit;
};

// The rectangle around all sectors, in sectors. REQUIRES: at least one sector.
[[nodiscard]] std::size_t covered_sectors(const std::vector<Sector>& sectors);

inline constexpr std::size_t max_covered_sectors = std::size_t{1} << 18;

// REQUIRES: at least one sector, covered_sectors(sectors) <= max_covered_sectors.
[[nodiscard]] Image draw_region(const std::vector<Sector>& sectors, const PictureOptions& options);

}  // namespace drtv::tool
