// PNG files, 8-bit RGB. Written here because format/ may depend on zstd only: deflate with the fixed Huffman
// codes (RFC 1950, 1951; PNG specification, third edition) is enough for pictures of a few megapixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace drtv::tool {

struct Image {
    std::size_t width = 0, height = 0;
    std::vector<std::uint8_t> rgb;  // rows from the top, 3 bytes a pixel

    Image(std::size_t w, std::size_t h) : width(w), height(h), rgb(w * h * 3) {}
    [[nodiscard]] std::uint8_t* at(std::size_t x, std::size_t y) { return &rgb[(y * width + x) * 3]; }
};

[[nodiscard]] std::vector<std::uint8_t> encode_png(const Image& image);

}  // namespace drtv::tool
