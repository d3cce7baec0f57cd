#include "bakerd/map/texture_filter.h"

#include "bakerd/map/texel.h"
#include "bakerd/map/texture_alpha.h"

#include <algorithm>
#include <vector>

namespace drtv::map {
namespace {

// Colour times coverage, coverage.
struct Premultiplied {
    std::uint32_t width;
    std::uint32_t height;
    std::vector<glm::vec4> texels;
};

Premultiplied premultiplied(const Texture& texture) {
    Premultiplied level{texture.width, texture.height, {}};
    const std::size_t count = std::size_t{level.width} * level.height;
    level.texels.reserve(count);
    for (std::size_t n = 0; n < count; ++n) {
        const std::uint8_t* rgba = &texture.rgba[n * 4];
        const glm::vec4 whole(linear_colour(rgba), 1);
        level.texels.push_back(whole * coverage_of(texture, rgba[3]));
    }
    return level;
}

// Each new texel of a line is the mean over the span of old ones that it covers, parts of texels included: so
// that an odd size shifts no mean.
template <class Read, class Write>
void shrink(std::uint32_t from_size, std::uint32_t to_size, Read read, Write write) {
    const double step = static_cast<double>(from_size) / to_size;
    for (std::uint32_t n = 0; n < to_size; ++n) {
        const double low = n * step;
        const double high = (n + 1) * step;
        glm::vec4 sum(0);
        for (auto k = static_cast<std::uint32_t>(low); k < from_size && k < high; ++k) {
            const double begin = k;
            const double covered = std::min(high, begin + 1) - std::max(low, begin);
            sum += read(k) * static_cast<float>(covered / step);
        }
        write(n, sum);
    }
}

Premultiplied halved(const Premultiplied& from) {
    Premultiplied to{std::max(1u, from.width / 2), std::max(1u, from.height / 2), {}};
    std::vector<glm::vec4> rows(std::size_t{to.width} * from.height);
    for (std::size_t y = 0; y < from.height; ++y) {
        const glm::vec4* from_row = &from.texels[y * from.width];
        glm::vec4* to_row = &rows[y * to.width];
        shrink(
            from.width,
            to.width,
            [&](std::uint32_t x) { return from_row[x]; },
            [&](std::uint32_t x, const glm::vec4& v) { to_row[x] = v; });
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
        for (glm::length_t k = 0; k < 4; ++k) {
            const float bounded = std::min(texel[k], 1.0f);
            mip.rgba.push_back(static_cast<std::uint16_t>(bounded * 65535.0f + 0.5f));
        }
    }
    return mip;
}

}  // namespace

void prefilter(Texture& texture) {
    texture.mips.clear();
    Premultiplied level = premultiplied(texture);
    while (level.width > 1 || level.height > 1) {
        level = halved(level);
        texture.mips.push_back(stored(level));
    }
    texture.alpha_blocks.clear();
    if (texture.coverage != Coverage::whole)
        texture.alpha_blocks = alpha_blocks_of(texture);
}

}  // namespace drtv::map
