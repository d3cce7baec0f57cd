#include "canvas.h"

#include <stb/stb_easy_font.h>

#include <algorithm>
#include <string>
#include <vector>

namespace drtv::image {
namespace {

PixelRect clipped(const Image& image, const PixelRect& rect) {
    const int width = static_cast<int>(image.width);
    const int height = static_cast<int>(image.height);
    return {std::clamp(rect.x0, 0, width),
            std::clamp(rect.y0, 0, height),
            std::clamp(rect.x1, 0, width),
            std::clamp(rect.y1, 0, height)};
}

template <class Paint>
void for_each_pixel(Image& image, const PixelRect& rect, Paint paint) {
    const PixelRect part = clipped(image, rect);
    for (int y = part.y0; y < part.y1; ++y) {
        for (int x = part.x0; x < part.x1; ++x)
            paint(image.at(static_cast<std::size_t>(x), static_cast<std::size_t>(y)));
    }
}

std::string in_ascii(std::string_view text) {
    std::string ascii(text);
    for (char& c : ascii) {
        if (c < 0x20 || c > 0x7E)
            c = '?';
    }
    return ascii;
}

}  // namespace

void fill(Image& image, const PixelRect& rect, const Colour& colour) {
    for_each_pixel(image, rect, [&](std::uint8_t* pixel) { std::ranges::copy(colour, pixel); });
}

void blend(Image& image, const PixelRect& rect, const Colour& colour, float share) {
    for_each_pixel(image, rect, [&](std::uint8_t* pixel) {
        for (std::size_t c = 0; c < 3; ++c) {
            const auto old = static_cast<float>(pixel[c]);
            const auto full = static_cast<float>(colour[c]);
            pixel[c] = static_cast<std::uint8_t>(old + (full - old) * share + 0.5f);
        }
    });
}

void frame(Image& image, const PixelRect& rect, const Colour& colour, int width) {
    fill(image, {rect.x0, rect.y0, rect.x1, std::min(rect.y0 + width, rect.y1)}, colour);
    fill(image, {rect.x0, std::max(rect.y1 - width, rect.y0), rect.x1, rect.y1}, colour);
    fill(image, {rect.x0, rect.y0, std::min(rect.x0 + width, rect.x1), rect.y1}, colour);
    fill(image, {std::max(rect.x1 - width, rect.x0), rect.y0, rect.x1, rect.y1}, colour);
}

void write_text(Image& image, int x, int y, std::string_view text, const Colour& colour, int scale) {
    // Four corners a quad: x, y, z and a colour each.
    struct Corner {
        float x, y, z;
        std::array<unsigned char, 4> colour;
    };
    constexpr std::size_t corners_a_letter = 64;
    std::string ascii = in_ascii(text);
    std::vector<Corner> corners(corners_a_letter * (ascii.size() + 1));
    const int bytes = static_cast<int>(corners.size() * sizeof(Corner));
    const int quads = stb_easy_font_print(0, 0, ascii.data(), nullptr, corners.data(), bytes);
    for (std::size_t n = 0; n < static_cast<std::size_t>(quads); ++n) {
        const Corner& low = corners[4 * n];
        const Corner& high = corners[4 * n + 2];
        const auto at = [scale](int from, float pixels) { return from + scale * static_cast<int>(pixels); };
        fill(image, {at(x, low.x), at(y, low.y), at(x, high.x), at(y, high.y)}, colour);
    }
}

int text_width(std::string_view text, int scale) {
    std::string ascii = in_ascii(text);
    return stb_easy_font_width(ascii.data()) * scale;
}

void write_caption(Image& image, int x, int y, std::string_view text, int scale) {
    constexpr Colour dark = {16, 16, 16};
    constexpr Colour light = {235, 235, 235};
    const int margin = 3 * scale;
    fill(image, {x, y, x + text_width(text, scale) + 2 * margin, y + 8 * scale + 2 * margin}, dark);
    write_text(image, x + margin, y + margin, text, light, scale);
}

}  // namespace drtv::image
