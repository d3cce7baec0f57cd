#include "bakerd/map/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

// stb_image stays in this file, with its symbols private.
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

namespace drtv::map {
namespace {

constexpr std::size_t max_pixels = std::size_t{1} << 26;

std::array<float, 256> make_linear_from_srgb() {
    std::array<float, 256> table{};
    for (std::size_t n = 0; n < table.size(); ++n) {
        const double s = static_cast<double>(n) / 255;
        table[n] = static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    }
    return table;
}

// IEC 61966-2-1. Correctly rounded from double, so that the last bit of pow does not show.
const std::array<float, 256> linear_from_srgb = make_linear_from_srgb();

std::uint32_t wrapped(std::int64_t texel, std::uint32_t size, Wrap wrap) {
    const auto n = static_cast<std::int64_t>(size);
    if (wrap == Wrap::clamp) return static_cast<std::uint32_t>(texel < 0 ? 0 : texel >= n ? n - 1 : texel);
    const std::int64_t period = wrap == Wrap::mirror ? 2 * n : n;
    std::int64_t r = texel % period;
    if (r < 0) r += period;
    return static_cast<std::uint32_t>(r < n ? r : period - 1 - r);
}

glm::vec4 texel(const Texture& texture, std::uint32_t x, std::uint32_t y) {
    const std::uint8_t* p = &texture.rgba[(std::size_t{y} * texture.width + x) * 4];
    return {linear_from_srgb[p[0]], linear_from_srgb[p[1]], linear_from_srgb[p[2]], static_cast<float>(p[3]) / 255.0f};
}

// Beyond this a float holds no position inside the texture any more. What is no number lands there too.
float bounded(float v) { return v > -1e6f ? std::min(v, 1e6f) : -1e6f; }

// stb_image 2.27 writes a Huffman table of any length into room for 256 codes. So the segments are walked as it walks
// them, and such a table is refused first.
bool has_oversized_huffman_table(std::span<const std::uint8_t> jpeg) {
    for (std::size_t at = 0; at + 1 < jpeg.size();) {
        const std::uint8_t marker = jpeg[at + 1];
        if (jpeg[at] != 0xFF || marker == 0xFF) {
            ++at;
            continue;
        }
        at += 2;
        const bool alone = marker == 0x00 || marker == 0x01 || (marker >= 0xD0 && marker <= 0xD9);  // no segment follows
        if (alone || at + 2 > jpeg.size()) continue;
        const std::size_t end = at + (std::size_t{jpeg[at]} << 8 | jpeg[at + 1]);
        if (marker == 0xC4) {
            for (std::size_t table = at + 2; table < end && table + 17 <= jpeg.size();) {
                const std::size_t codes = std::accumulate(&jpeg[table + 1], &jpeg[table] + 17, std::size_t{0});
                if (codes > 256) return true;
                table += 17 + codes;
            }
        }
        at = std::max(end, at + 2);
    }
    return false;
}

}  // namespace

tl::expected<Texture, std::string> decode_texture(std::span<const std::uint8_t> encoded) {
    int width = 0, height = 0, channels = 0;
    if (encoded.size() > 1 && encoded[0] == 0xFF && has_oversized_huffman_table(encoded)) return tl::unexpected(std::string("a Huffman table of the JPEG has over 256 codes"));
    const int size = static_cast<int>(encoded.size());
    if (stbi_info_from_memory(encoded.data(), size, &width, &height, &channels) == 0) {
        return tl::unexpected(std::string("it is neither PNG nor JPEG"));
    }
    if (width <= 0 || height <= 0 || static_cast<std::size_t>(width) * static_cast<std::size_t>(height) > max_pixels) {
        return tl::unexpected(fmt::format("its {} x {} pixels are over the limit of {}", width, height, max_pixels));
    }
    stbi_uc* pixels = stbi_load_from_memory(encoded.data(), size, &width, &height, &channels, 4);
    if (pixels == nullptr) return tl::unexpected(fmt::format("it cannot be decoded: {}", stbi_failure_reason()));
    Texture texture;
    texture.width = static_cast<std::uint32_t>(width);
    texture.height = static_cast<std::uint32_t>(height);
    texture.rgba.assign(pixels, pixels + std::size_t{texture.width} * texture.height * 4);
    stbi_image_free(pixels);
    return texture;
}

glm::vec4 sample(const Texture& texture, glm::vec2 uv) {
    const float x = bounded(uv.x) * static_cast<float>(texture.width) - 0.5f, y = bounded(uv.y) * static_cast<float>(texture.height) - 0.5f;
    const float fx = std::floor(x), fy = std::floor(y);
    const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy);
    const float tx = x - fx, ty = y - fy;
    const std::uint32_t x0 = wrapped(ix, texture.width, texture.wrap_u), x1 = wrapped(ix + 1, texture.width, texture.wrap_u);
    const std::uint32_t y0 = wrapped(iy, texture.height, texture.wrap_v), y1 = wrapped(iy + 1, texture.height, texture.wrap_v);
    const glm::vec4 low = texel(texture, x0, y0) * (1 - tx) + texel(texture, x1, y0) * tx;
    const glm::vec4 high = texel(texture, x0, y1) * (1 - tx) + texel(texture, x1, y1) * tx;
    return low * (1 - ty) + high * ty;
}

}  // namespace drtv::map
