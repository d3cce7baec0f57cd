#include "client/canvas.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

#include <algorithm>
#include <cstddef>

namespace drtv::client {
namespace {

void append(void* text, void* data, int size) {
    const auto* bytes = static_cast<const char*>(data);
    static_cast<std::string*>(text)->append(bytes, static_cast<std::size_t>(size));
}

}  // namespace

Canvas::Canvas(int width, int height, const Colour& background) : width_(width), height_(height) {
    for (int n = 0; n < width * height; ++n)
        rgb_.insert(rgb_.end(), background.begin(), background.end());
}

void Canvas::dot(int x, int y, const Colour& colour) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_)
        return;
    const std::ptrdiff_t pixel = std::ptrdiff_t{y} * width_ + x;
    std::ranges::copy(colour, rgb_.begin() + pixel * 3);
}

void Canvas::fill(const PixelRect& rect, const Colour& colour) {
    for (int y = rect.y0; y < rect.y1; ++y) {
        for (int x = rect.x0; x < rect.x1; ++x)
            dot(x, y, colour);
    }
}

void Canvas::frame(const PixelRect& rect, const Colour& colour) {
    for (int x = rect.x0; x <= rect.x1; ++x) {
        dot(x, rect.y0, colour);
        dot(x, rect.y1, colour);
    }
    for (int y = rect.y0; y <= rect.y1; ++y) {
        dot(rect.x0, y, colour);
        dot(rect.x1, y, colour);
    }
}

cli::Result<std::string> Canvas::png() const {
    constexpr int channels = 3;
    std::string png;
    if (stbi_write_png_to_func(append, &png, width_, height_, channels, rgb_.data(), width_ * channels) == 0)
        return cli::fail(cli::exit_unreadable, "memory is too short for the picture");
    return png;
}

}  // namespace drtv::client
