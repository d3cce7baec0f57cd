#include "png.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

#include <cstring>

// A PNG may have an empty IDAT chunk, whose no bytes stb_image 2.27 copies to a null pointer.
#define memcpy(to, from, size) ((size) == 0 ? (to) : (memcpy)(to, from, size))
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#include <stb/stb_image.h>
#undef memcpy

#include <algorithm>
#include <array>
#include <memory>

namespace drtv::image {
namespace {

void append(void* png, void* data, int size) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    auto& out = *static_cast<std::vector<std::uint8_t>*>(png);
    out.insert(out.end(), bytes, bytes + size);
}

// A file begins with 8 bytes of its own and the chunk IHDR of 13.
constexpr std::size_t signature_bytes = 8;
constexpr std::size_t after_header = signature_bytes + 25;
constexpr std::size_t chunk_frame = 12;  // length, type, checksum

void append_big_endian(std::vector<std::uint8_t>& out, std::uint32_t number) {
    for (int shift = 24; shift >= 0; shift -= 8)
        out.push_back(static_cast<std::uint8_t>(number >> shift & 255));
}

std::uint32_t big_endian(std::span<const std::uint8_t> bytes) {
    std::uint32_t number = 0;
    for (std::size_t n = 0; n < 4; ++n)
        number = number << 8 | bytes[n];
    return number;
}

std::vector<std::uint8_t> text_chunk(const PngText& text) {
    std::string data = "tEXt" + text.key;
    data.push_back('\0');
    data += text.text;
    std::vector<std::uint8_t> chunk;
    append_big_endian(chunk, static_cast<std::uint32_t>(data.size() - 4));
    chunk.insert(chunk.end(), data.begin(), data.end());
    append_big_endian(chunk, stbiw__crc32(chunk.data() + 4, static_cast<int>(data.size())));
    return chunk;
}

std::string size_text(int width, int height) {
    return std::to_string(width) + " x " + std::to_string(height) + " pixels";
}

}  // namespace

cli::Result<std::vector<std::uint8_t>> encode_png(const Image& image, const std::vector<PngText>& texts) {
    constexpr int channels = 3;
    const int width = static_cast<int>(image.width);
    const int height = static_cast<int>(image.height);
    std::vector<std::uint8_t> png;
    if (stbi_write_png_to_func(append, &png, width, height, channels, image.rgb.data(), width * channels) ==
        0) {
        return cli::fail(cli::exit_unreadable, "memory is too short for " + size_text(width, height));
    }
    for (const PngText& text : texts) {
        const std::vector<std::uint8_t> chunk = text_chunk(text);
        png.insert(png.begin() + after_header, chunk.begin(), chunk.end());
    }
    return png;
}

cli::Result<Image> decode_png(std::span<const std::uint8_t> png) {
    constexpr int max_pixels = 64'000'000;
    const auto length = static_cast<int>(std::min<std::size_t>(png.size(), INT32_MAX));
    int width = 0, height = 0, channels = 0;
    if (stbi_info_from_memory(png.data(), length, &width, &height, &channels) == 0)
        return cli::fail(cli::exit_invalid, "it is no PNG file");
    if (std::int64_t{width} * height > max_pixels)
        return cli::fail(cli::exit_invalid, "it has " + size_text(width, height) + ", over 64 million");
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(png.data(), length, &width, &height, &channels, 3), stbi_image_free);
    if (!pixels)
        return cli::fail(cli::exit_invalid, "it is damaged");
    Image image(static_cast<std::size_t>(width), static_cast<std::size_t>(height));
    std::copy_n(pixels.get(), image.rgb.size(), image.rgb.begin());
    return image;
}

std::optional<std::string> png_text(std::span<const std::uint8_t> png, std::string_view key) {
    for (std::size_t at = signature_bytes; at + chunk_frame <= png.size();) {
        const std::size_t length = big_endian(png.subspan(at));
        if (length > png.size() - at - chunk_frame)
            break;
        const auto* bytes = reinterpret_cast<const char*>(png.data()) + at + 4;
        const std::string_view type(bytes, 4);
        const std::string_view data(bytes + 4, length);
        const std::size_t end = data.find('\0');
        if (type == "tEXt" && data.substr(0, end) == key && end != data.npos)
            return std::string(data.substr(end + 1));
        at += length + chunk_frame;
    }
    return std::nullopt;
}

}  // namespace drtv::image
