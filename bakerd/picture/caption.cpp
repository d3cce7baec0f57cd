#include "bakerd/picture/caption.h"

#include <stb/stb_easy_font.h>

#include <algorithm>
#include <array>

namespace drtv::picture {
namespace {

constexpr std::size_t scale = 2;
constexpr std::size_t margin = 3;       // of the font's pixels
constexpr std::size_t text_height = 8;  // likewise

void fill(
    kit::Image& image, std::size_t x0, std::size_t y0, std::size_t x1, std::size_t y1, std::uint8_t grey) {
    for (std::size_t y = y0; y < std::min(y1, image.height); ++y) {
        for (std::size_t x = x0; x < std::min(x1, image.width); ++x)
            std::fill_n(image.at(x, y), 3, grey);
    }
}

}  // namespace

void write_caption(kit::Image& image, std::size_t x, std::size_t y, const std::string& text) {
    // Four corners a quad, x, y, z and a colour each.
    struct Corner {
        float x, y, z;
        std::array<unsigned char, 4> colour;
    };
    std::array<Corner, 4096> corners{};
    std::string changed = text;
    const int quads = stb_easy_font_print(0, 0, changed.data(), nullptr, corners.data(), sizeof corners);
    const auto width = static_cast<std::size_t>(stb_easy_font_width(changed.data()));
    fill(image, x, y, x + scale * (width + 2 * margin), y + scale * (text_height + 2 * margin), 16);
    for (std::size_t n = 0; n < static_cast<std::size_t>(quads); ++n) {
        const Corner& low = corners[4 * n];
        const Corner& high = corners[4 * n + 2];
        const auto at = [](std::size_t from, float pixels) {
            return from + scale * (margin + static_cast<std::size_t>(pixels));
        };
        fill(image, at(x, low.x), at(y, low.y), at(x, high.x), at(y, high.y), 235);
    }
}

}  // namespace drtv::picture
