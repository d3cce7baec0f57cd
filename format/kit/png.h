// PNG files, 8-bit RGB, encoded by stb.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace drtv::kit {

struct Image {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<std::uint8_t> rgb;  // rows from the top, 3 bytes a pixel

    Image(std::size_t w, std::size_t h) : width(w), height(h), rgb(w * h * 3) {}

    // The three bytes of a pixel.
    [[nodiscard]] std::uint8_t* at(std::size_t x, std::size_t y) {
        const std::size_t pixel = y * width + x;
        return &rgb[pixel * 3];
    }
};

// Empty where memory is short.
[[nodiscard]] std::vector<std::uint8_t> encode_png(const Image& image);

}  // namespace drtv::kit
