// Rectangles and text on an image. Pixels count from the top left; what lies outside is cut off.
#pragma once

#include "image/png.h"

#include <array>
#include <cstdint>
#include <string_view>

namespace drtv::image {

using Colour = std::array<std::uint8_t, 3>;  // sRGB

inline constexpr Colour white = {255, 255, 255};

struct PixelRect {
    int x0;
    int y0;
    int x1;  // behind the last
    int y1;
};

void fill(Image& image, const PixelRect& rect, const Colour& colour);

// The share of `colour` that each pixel gets; the rest stays.
void blend(Image& image, const PixelRect& rect, const Colour& colour, float share);

// The outermost pixels of the rectangle, `width` of them.
void frame(Image& image, const PixelRect& rect, const Colour& colour, int width = 1);

// A line of text in a plain font of pixels `scale` wide; (x, y) is its upper left corner. Of other characters
// than those of ASCII each byte is a question mark.
void write_text(Image& image, int x, int y, std::string_view text, const Colour& colour, int scale);
[[nodiscard]] int text_width(std::string_view text, int scale);
[[nodiscard]] constexpr int text_height(int scale) {
    return 9 * scale;
}

// White on a dark bar.
void write_caption(Image& image, int x, int y, std::string_view text, int scale = 2);

}  // namespace drtv::image
