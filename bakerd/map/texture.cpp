#include "bakerd/map/texture.h"

#include "bakerd/map/texel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace drtv::map {
namespace {

template <class Counts>
glm::vec3 brightest_where(const Texture& texture, Counts counts) {
    std::array<std::uint8_t, 3> largest{};
    for (std::size_t n = 0; n < texture.rgba.size(); n += 4) {
        if (!counts(texture.rgba[n + 3]))
            continue;
        for (std::size_t k = 0; k < 3; ++k)
            largest[k] = std::max(largest[k], texture.rgba[n + k]);
    }
    return linear_colour(largest.data());
}

template <class Value>
Value blended(const Value& low, const Value& high, float share) {
    return low * (1 - share) + high * share;
}

// The four texels around a point, and how far it lies between them.
struct Bilinear {
    std::uint32_t x0;
    std::uint32_t x1;
    std::uint32_t y0;
    std::uint32_t y1;
    float tx;
    float ty;
};

// Around a point of a level, whose picture wraps so.
template <class Level>
Bilinear around(glm::vec2 uv, const Level& level, const Texture& picture) {
    const float x = texel_coordinate(uv.x, level.width);
    const float y = texel_coordinate(uv.y, level.height);
    const float left = std::floor(x);
    const float top = std::floor(y);
    const auto column = static_cast<std::int64_t>(left);
    const auto row = static_cast<std::int64_t>(top);
    Bilinear at;
    at.x0 = wrapped(column, level.width, picture.wrap_u);
    at.x1 = wrapped(column + 1, level.width, picture.wrap_u);
    at.y0 = wrapped(row, level.height, picture.wrap_v);
    at.y1 = wrapped(row + 1, level.height, picture.wrap_v);
    at.tx = x - left;
    at.ty = y - top;
    return at;
}

template <class Fetch>
auto mixed(const Bilinear& at, Fetch fetch) {
    const auto top = blended(fetch({at.x0, at.y0}), fetch({at.x1, at.y0}), at.tx);
    const auto bottom = blended(fetch({at.x0, at.y1}), fetch({at.x1, at.y1}), at.tx);
    return blended(top, bottom, at.ty);
}

float sample_channel(const Texture& texture, glm::vec2 uv, std::size_t channel) {
    return mixed(around(uv, texture, texture), [&](TexelPlace at) {
        const std::uint8_t* rgba = bytes_of(texture, at);
        return share_of(rgba[channel]);
    });
}

}  // namespace

glm::vec3 brightest(const Texture& texture) {
    const auto is_there = [&](std::uint8_t alpha) { return coverage_of(texture, alpha) > 0; };
    return brightest_where(texture, is_there);
}

glm::vec3 brightest_of_all(const Texture& texture) {
    const glm::vec3 largest = brightest_where(texture, [](std::uint8_t) { return true; });
    if (texture.coverage == Coverage::whole)
        return largest;
    // Mip levels round the little that is there next to nothing (sample_filtered).
    constexpr float rounding = 1 / 63.0f;
    return glm::min(largest + rounding, glm::vec3(1));
}

glm::vec3 sample_filtered(const Texture& texture, glm::vec2 uv, std::uint32_t level) {
    if (level == 0 || texture.mips.empty())
        return glm::vec3(sample(texture, uv));
    const std::size_t last = texture.mips.size();
    const MipLevel& mip = texture.mips[std::min<std::size_t>(level, last) - 1];
    const glm::vec4 sum = mixed(around(uv, mip, texture), [&](TexelPlace at) {
        const std::uint16_t* rgba = &mip.rgba[offset_of(at, mip.width)];
        return glm::vec4(rgba[0], rgba[1], rgba[2], rgba[3]);
    });
    // Where hardly anything is there, the little colour left has no digits.
    if (sum.w < 64)
        return glm::vec3(sample(texture, uv));
    return glm::vec3(sum) / sum.w;
}

float sample_alpha(const Texture& texture, glm::vec2 uv) {
    return sample_channel(texture, uv, 3);
}

float sample_red(const Texture& texture, glm::vec2 uv) {
    return sample_channel(texture, uv, 0);
}

glm::vec4 sample(const Texture& texture, glm::vec2 uv) {
    return mixed(around(uv, texture, texture), [&](TexelPlace at) {
        const std::uint8_t* rgba = bytes_of(texture, at);
        return glm::vec4(linear_colour(rgba), share_of(rgba[3]));
    });
}

}  // namespace drtv::map
