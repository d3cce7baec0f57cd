// The frame of a map from above: what it shows, coordinates and sector numbers, scale bar, north, legend.
#pragma once

#include "image/canvas.h"
#include "image/map_extent.h"
#include "image/png.h"

#include <cstddef>
#include <string>
#include <vector>

namespace drtv::image {

// No side of a framed picture has fewer pixels, or more.
inline constexpr std::size_t min_sheet_side = 512;
inline constexpr std::size_t max_sheet_side = 8192;

struct LegendEntry {
    Colour colour;
    std::string text;
};

struct SheetText {
    std::string title;  // what the map shows
    std::vector<LegendEntry> legend;
};

struct MapSheet {
    Image image;
    std::vector<PngText> texts;  // which part of the world it shows, and where the map stands in it
};

// Left and below the map stand metres, above and right of it the numbers i and j of sectors. REQUIRES: the
// map is that of the extent.
[[nodiscard]] MapSheet framed(const Image& map, const MapExtent& extent, const SheetText& text);

}  // namespace drtv::image
