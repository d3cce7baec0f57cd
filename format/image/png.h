// PNG files, 8-bit RGB, by stb.
#pragma once

#include "cli/failure.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace drtv::image {

struct Image {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<std::uint8_t> rgb;  // rows from the top, 3 bytes per pixel

    Image(std::size_t w, std::size_t h) : width(w), height(h), rgb(w * h * 3) {}

    // The three bytes of a pixel.
    [[nodiscard]] std::uint8_t* at(std::size_t x, std::size_t y) {
        const std::size_t pixel = y * width + x;
        return &rgb[pixel * 3];
    }
    [[nodiscard]] const std::uint8_t* at(std::size_t x, std::size_t y) const {
        return const_cast<Image*>(this)->at(x, y);
    }
};

// Names the part of the world that a picture from above shows: x0,y0,x1,y1 in metres.
inline constexpr const char* world_rectangle_key = "drtv:world";
// Names the pixels of such a picture that show the map, where a frame is around it: x0,y0,x1,y1, the last two
// behind it.
inline constexpr const char* map_rectangle_key = "drtv:map";

// A line of text in the file, which pictures are shown without: Latin-1, the key 1 to 79 characters.
struct PngText {
    std::string key;
    std::string text;
};

// Fails where memory is short.
[[nodiscard]] cli::Result<std::vector<std::uint8_t>> encode_png(const Image& image,
                                                                const std::vector<PngText>& texts = {});

// Fails where the bytes are no PNG file of at most 64 million pixels. Transparency is left out.
[[nodiscard]] cli::Result<Image> decode_png(std::span<const std::uint8_t> png);

// The first text of that key; nothing where there is none.
[[nodiscard]] std::optional<std::string> png_text(std::span<const std::uint8_t> png, std::string_view key);

}  // namespace drtv::image
