#include "bakerd/map/texture_decode.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>

// A PNG may have an empty IDAT chunk, whose no bytes stb_image 2.27 copies to a null pointer.
#define memcpy(to, from, size) ((size) == 0 ? (to) : (memcpy)(to, from, size))
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop
#undef memcpy

namespace drtv::map {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t max_pixels = std::size_t{1} << 26;

// No segment follows such a marker.
bool stands_alone(std::uint8_t marker) {
    const bool is_restart_or_end = marker >= 0xD0 && marker <= 0xD9;
    return marker == 0x00 || marker == 0x01 || is_restart_or_end;
}

// Whether one of the tables in jpeg[at, end) has more codes than stb_image has room for.
bool has_oversized_table(Bytes jpeg, std::size_t at, std::size_t end) {
    while (at < end && at + 17 <= jpeg.size()) {
        const Bytes counts = jpeg.subspan(at + 1, 16);  // of codes, by length
        const std::size_t codes = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
        if (codes > 256)
            return true;
        at += 17 + codes;
    }
    return false;
}

// stb_image 2.27 writes a Huffman table of any length into room for 256 codes. So the segments are walked as
// it walks them, and such a table is refused first.
bool has_oversized_huffman_table(Bytes jpeg) {
    constexpr std::uint8_t define_tables = 0xC4;
    for (std::size_t at = 0; at + 1 < jpeg.size();) {
        const std::uint8_t marker = jpeg[at + 1];
        if (jpeg[at] != 0xFF || marker == 0xFF) {
            ++at;
            continue;
        }
        at += 2;
        if (stands_alone(marker) || at + 2 > jpeg.size())
            continue;
        const std::size_t length = std::size_t{jpeg[at]} << 8 | jpeg[at + 1];
        const std::size_t end = at + length;
        if (marker == define_tables && has_oversized_table(jpeg, at + 2, end))
            return true;
        at = std::max(end, at + 2);
    }
    return false;
}

bool is_jpeg(Bytes encoded) {
    return encoded.size() > 1 && encoded[0] == 0xFF;
}

}  // namespace

tl::expected<Texture, std::string> decode_texture(Bytes encoded) {
    if (is_jpeg(encoded) && has_oversized_huffman_table(encoded))
        return tl::unexpected(std::string("a Huffman table of the JPEG has over 256 codes"));
    int width = 0;
    int height = 0;
    int channels = 0;
    const int size = static_cast<int>(encoded.size());
    if (stbi_info_from_memory(encoded.data(), size, &width, &height, &channels) == 0)
        return tl::unexpected(std::string("it is neither PNG nor JPEG"));
    if (width <= 0 || height <= 0 ||
        static_cast<std::size_t>(width) * static_cast<std::size_t>(height) > max_pixels) {
        return tl::unexpected(
            fmt::format("its {} x {} pixels are over the limit of {}", width, height, max_pixels));
    }
    stbi_uc* pixels = stbi_load_from_memory(encoded.data(), size, &width, &height, &channels, 4);
    if (pixels == nullptr)
        return tl::unexpected(fmt::format("it cannot be decoded: {}", stbi_failure_reason()));
    Texture texture;
    texture.width = static_cast<std::uint32_t>(width);
    texture.height = static_cast<std::uint32_t>(height);
    const std::size_t size_bytes = std::size_t{texture.width} * texture.height * 4;
    texture.rgba.assign(pixels, pixels + size_bytes);
    stbi_image_free(pixels);
    return texture;
}

}  // namespace drtv::map
