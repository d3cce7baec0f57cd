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
    if (texel >= 0 && texel < n)
        return static_cast<std::uint32_t>(texel);  // nearly always, and division is slow
    if (wrap == Wrap::clamp)
        return static_cast<std::uint32_t>(texel < 0 ? 0 : texel >= n ? n - 1 : texel);
    const std::int64_t period = wrap == Wrap::mirror ? 2 * n : n;
    std::int64_t r = texel % period;
    if (r < 0)
        r += period;
    return static_cast<std::uint32_t>(r < n ? r : period - 1 - r);
}

glm::vec4 texel(const Texture& texture, std::uint32_t x, std::uint32_t y) {
    const std::uint8_t* p = &texture.rgba[(std::size_t{y} * texture.width + x) * 4];
    return {linear_from_srgb[p[0]],
            linear_from_srgb[p[1]],
            linear_from_srgb[p[2]],
            static_cast<float>(p[3]) / 255.0f};
}

float coverage_of(const Texture& texture, std::uint8_t alpha) {
    switch (texture.coverage) {
        case Coverage::whole:
            return 1;
        case Coverage::alpha:
            return static_cast<float>(alpha) / 255.0f;
        case Coverage::cutoff:
            return static_cast<float>(alpha) / 255.0f >= texture.cutoff ? 1.0f : 0.0f;
    }
    return 1;
}

// Colour times coverage, coverage.
struct Premultiplied {
    std::uint32_t width, height;
    std::vector<glm::vec4> texels;
};

Premultiplied premultiplied(const Texture& texture) {
    Premultiplied level{texture.width, texture.height, {}};
    level.texels.reserve(std::size_t{level.width} * level.height);
    for (std::size_t n = 0; n < std::size_t{level.width} * level.height; ++n) {
        const std::uint8_t* p = &texture.rgba[n * 4];
        level.texels.push_back(
            glm::vec4(linear_from_srgb[p[0]], linear_from_srgb[p[1]], linear_from_srgb[p[2]], 1) *
            coverage_of(texture, p[3]));
    }
    return level;
}

// Each new texel is the mean over the span of old ones that it covers, parts of texels included: so that an
// odd size shifts no mean.
Premultiplied halved(const Premultiplied& from) {
    Premultiplied to{std::max(1u, from.width / 2), std::max(1u, from.height / 2), {}};
    const auto shrink = [](std::uint32_t from_size, std::uint32_t to_size, auto read, auto write) {
        const double step = static_cast<double>(from_size) / to_size;
        for (std::uint32_t n = 0; n < to_size; ++n) {
            const double low = n * step, high = (n + 1) * step;
            glm::vec4 sum(0);
            for (auto k = static_cast<std::uint32_t>(low); k < from_size && k < high; ++k)
                sum += read(k) * static_cast<float>((std::min(high, static_cast<double>(k) + 1) -
                                                     std::max(low, static_cast<double>(k))) /
                                                    step);
            write(n, sum);
        }
    };
    std::vector<glm::vec4> rows(std::size_t{to.width} * from.height);
    for (std::size_t y = 0; y < from.height; ++y) {
        shrink(
            from.width,
            to.width,
            [&](std::uint32_t x) { return from.texels[y * from.width + x]; },
            [&](std::uint32_t x, const glm::vec4& v) { rows[y * to.width + x] = v; });
    }
    to.texels.resize(std::size_t{to.width} * to.height);
    for (std::size_t x = 0; x < to.width; ++x) {
        shrink(
            from.height,
            to.height,
            [&](std::uint32_t y) { return rows[y * to.width + x]; },
            [&](std::uint32_t y, const glm::vec4& v) { to.texels[y * to.width + x] = v; });
    }
    return to;
}

MipLevel stored(const Premultiplied& level) {
    MipLevel mip{level.width, level.height, {}};
    mip.rgba.reserve(level.texels.size() * 4);
    for (const glm::vec4& texel : level.texels) {
        for (glm::length_t k = 0; k < 4; ++k)
            mip.rgba.push_back(static_cast<std::uint16_t>(std::min(texel[k], 1.0f) * 65535.0f + 0.5f));
    }
    return mip;
}

std::uint32_t blocks_along(std::uint32_t texels) {
    return (texels + alpha_block_texels - 1) / alpha_block_texels;
}

std::vector<AlphaRange> ranges_of_alpha(const Texture& texture) {
    const std::uint32_t columns = blocks_along(texture.width), rows = blocks_along(texture.height);
    std::vector<AlphaRange> blocks(std::size_t{columns} * rows, {255, 0});
    for (std::uint32_t y = 0; y < texture.height; ++y) {
        for (std::uint32_t x = 0; x < texture.width; ++x) {
            AlphaRange& block =
                blocks[std::size_t{y / alpha_block_texels} * columns + x / alpha_block_texels];
            const std::uint8_t alpha = texture.rgba[(std::size_t{y} * texture.width + x) * 4 + 3];
            block.low = std::min(block.low, alpha);
            block.high = std::max(block.high, alpha);
        }
    }
    return blocks;
}

template <class Counts>
glm::vec3 brightest_where(const Texture& texture, Counts counts) {
    std::array<std::uint8_t, 3> most{};
    for (std::size_t n = 0; n < texture.rgba.size(); n += 4) {
        if (!counts(texture.rgba[n + 3]))
            continue;
        for (std::size_t k = 0; k < 3; ++k)
            most[k] = std::max(most[k], texture.rgba[n + k]);
    }
    return {linear_from_srgb[most[0]], linear_from_srgb[most[1]], linear_from_srgb[most[2]]};
}

// The four texels around a point, and how far it lies between them.
struct Bilinear {
    std::uint32_t x0, x1, y0, y1;
    float tx, ty;
};

// Beyond this a float holds no position inside the texture any more. What is no number lands there too.
float bounded(float v) {
    return v > -1e6f ? std::min(v, 1e6f) : -1e6f;
}

Bilinear bilinear(const Texture& texture, std::uint32_t width, std::uint32_t height, glm::vec2 uv) {
    const float x = bounded(uv.x) * static_cast<float>(width) - 0.5f,
                y = bounded(uv.y) * static_cast<float>(height) - 0.5f;
    const float fx = std::floor(x), fy = std::floor(y);
    const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy);
    return {wrapped(ix, width, texture.wrap_u),
            wrapped(ix + 1, width, texture.wrap_u),
            wrapped(iy, height, texture.wrap_v),
            wrapped(iy + 1, height, texture.wrap_v),
            x - fx,
            y - fy};
}

template <class Fetch>
auto mixed(const Bilinear& at, Fetch fetch) {
    const auto low = fetch(at.x0, at.y0) * (1 - at.tx) + fetch(at.x1, at.y0) * at.tx;
    const auto high = fetch(at.x0, at.y1) * (1 - at.tx) + fetch(at.x1, at.y1) * at.tx;
    return low * (1 - at.ty) + high * at.ty;
}

// stb_image 2.27 writes a Huffman table of any length into room for 256 codes. So the segments are walked as
// it walks them, and such a table is refused first.
bool has_oversized_huffman_table(std::span<const std::uint8_t> jpeg) {
    for (std::size_t at = 0; at + 1 < jpeg.size();) {
        const std::uint8_t marker = jpeg[at + 1];
        if (jpeg[at] != 0xFF || marker == 0xFF) {
            ++at;
            continue;
        }
        at += 2;
        const bool alone =
            marker == 0x00 || marker == 0x01 || (marker >= 0xD0 && marker <= 0xD9);  // no segment follows
        if (alone || at + 2 > jpeg.size())
            continue;
        const std::size_t end = at + (std::size_t{jpeg[at]} << 8 | jpeg[at + 1]);
        if (marker == 0xC4) {
            for (std::size_t table = at + 2; table < end && table + 17 <= jpeg.size();) {
                const std::size_t codes =
                    std::accumulate(&jpeg[table + 1], &jpeg[table] + 17, std::size_t{0});
                if (codes > 256)
                    return true;
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
    if (encoded.size() > 1 && encoded[0] == 0xFF && has_oversized_huffman_table(encoded))
        return tl::unexpected(std::string("a Huffman table of the JPEG has over 256 codes"));
    const int size = static_cast<int>(encoded.size());
    if (stbi_info_from_memory(encoded.data(), size, &width, &height, &channels) == 0) {
        return tl::unexpected(std::string("it is neither PNG nor JPEG"));
    }
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
    texture.rgba.assign(pixels, pixels + std::size_t{texture.width} * texture.height * 4);
    stbi_image_free(pixels);
    return texture;
}

void prefilter(Texture& texture) {
    texture.mips.clear();
    for (Premultiplied level = premultiplied(texture); level.width > 1 || level.height > 1;) {
        level = halved(level);
        texture.mips.push_back(stored(level));
    }
    texture.alpha_blocks.clear();
    if (texture.coverage != Coverage::whole)
        texture.alpha_blocks = ranges_of_alpha(texture);
}

AlphaRange alpha_range(const Texture& texture, glm::vec2 low, glm::vec2 high) {
    const std::uint32_t columns = blocks_along(texture.width), rows = blocks_along(texture.height);
    // Blocks along one axis that samples within [from, to] can read; all of them where the picture repeats
    // inside.
    const auto blocks = [](float from, float to, std::uint32_t size, std::uint32_t count, Wrap wrap) {
        std::vector<bool> touched(count, false);
        const auto first = static_cast<std::int64_t>(
                               std::floor(bounded(from) * static_cast<float>(size) - 0.5f)) -
                           1,
                   last =
                       static_cast<std::int64_t>(std::floor(bounded(to) * static_cast<float>(size) - 0.5f)) +
                       2;
        if (last - first >= std::int64_t{2} * size)
            return std::vector<bool>(count, true);
        for (std::int64_t texel = first; texel <= last; ++texel)
            touched[wrapped(texel, size, wrap) / alpha_block_texels] = true;
        return touched;
    };
    const std::vector<bool> across = blocks(low.x, high.x, texture.width, columns, texture.wrap_u),
                            down = blocks(low.y, high.y, texture.height, rows, texture.wrap_v);
    AlphaRange range{255, 0};
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; down[row] && column < columns; ++column) {
            if (!across[column])
                continue;
            const AlphaRange& block = texture.alpha_blocks[std::size_t{row} * columns + column];
            range = {std::min(range.low, block.low), std::max(range.high, block.high)};
            if (range.low == 0 && range.high == 255)
                return range;
        }
    }
    return range;
}

glm::vec3 brightest(const Texture& texture) {
    return brightest_where(texture, [&](std::uint8_t alpha) { return coverage_of(texture, alpha) > 0; });
}

glm::vec3 brightest_of_all(const Texture& texture) {
    const glm::vec3 most = brightest_where(texture, [](std::uint8_t) { return true; });
    // Mip levels round the little that is there next to nothing (sample_filtered).
    constexpr float rounding = 1 / 63.0f;
    return texture.coverage == Coverage::whole ? most : glm::min(most + rounding, glm::vec3(1));
}

glm::vec3 sample_filtered(const Texture& texture, glm::vec2 uv, std::uint32_t level) {
    if (level == 0 || texture.mips.empty())
        return glm::vec3(sample(texture, uv));
    const MipLevel& mip = texture.mips[std::min<std::size_t>(level, texture.mips.size()) - 1];
    const glm::vec4 sum =
        mixed(bilinear(texture, mip.width, mip.height, uv), [&](std::uint32_t x, std::uint32_t y) {
            const std::uint16_t* p = &mip.rgba[(std::size_t{y} * mip.width + x) * 4];
            return glm::vec4(p[0], p[1], p[2], p[3]);
        });
    // Where hardly anything is there, the little colour left has no digits.
    if (sum.w < 64)
        return glm::vec3(sample(texture, uv));
    return glm::vec3(sum) / sum.w;
}

float sample_alpha(const Texture& texture, glm::vec2 uv) {
    return mixed(bilinear(texture, texture.width, texture.height, uv), [&](std::uint32_t x, std::uint32_t y) {
        return static_cast<float>(texture.rgba[(std::size_t{y} * texture.width + x) * 4 + 3]) / 255.0f;
    });
}

glm::vec4 sample(const Texture& texture, glm::vec2 uv) {
    return mixed(bilinear(texture, texture.width, texture.height, uv),
                 [&](std::uint32_t x, std::uint32_t y) { return texel(texture, x, y); });
}

}  // namespace drtv::map
