// A region of sectors from above: probes as dots over a shaded map of sky visibility.
#pragma once

#include "png_writer.h"

#include <drtv/sector.h>

#include <vector>

namespace drtv::tool {

enum class DotQuantity { relit, sky };

struct PictureOptions {
    double metres_per_pixel = 0;  // 0: so that the longer side has about 1,600 pixels
    DotQuantity dots = DotQuantity::relit;
};

// REQUIRES: at least one sector.
[[nodiscard]] Image draw_region(const std::vector<Sector>& sectors, const PictureOptions& options);

}  // namespace drtv::tool
