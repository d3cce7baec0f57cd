// Single texels of a picture: where they stand, and what their bytes mean.
#pragma once

#include "bakerd/map/map.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace drtv::map {

// Linear value of each byte, IEC 61966-2-1. Not for use before main().
extern const std::array<float, 256> linear_from_srgb;

[[nodiscard]] inline glm::vec3 linear_colour(const std::uint8_t* rgb) {
    return {linear_from_srgb[rgb[0]], linear_from_srgb[rgb[1]], linear_from_srgb[rgb[2]]};
}

[[nodiscard]] inline float share_of(std::uint8_t alpha) {
    return static_cast<float>(alpha) / 255.0f;
}

struct TexelPlace {
    std::uint32_t x;
    std::uint32_t y;
};

// Where a texel's four channels begin in a picture of this width.
[[nodiscard]] inline std::size_t offset_of(TexelPlace at, std::uint32_t width) {
    return (std::size_t{at.y} * width + at.x) * 4;
}

// REQUIRES: the texel lies in the picture.
[[nodiscard]] inline const std::uint8_t* bytes_of(const Texture& texture, TexelPlace at) {
    return &texture.rgba[offset_of(at, texture.width)];
}

// How much of a texel of this alpha is there, in [0, 1].
[[nodiscard]] inline float coverage_of(const Texture& texture, std::uint8_t alpha) {
    switch (texture.coverage) {
        case Coverage::whole:
            return 1;
        case Coverage::alpha:
            return share_of(alpha);
        case Coverage::cutoff:
            return share_of(alpha) >= texture.cutoff ? 1.0f : 0.0f;
    }
    return 1;
}

// The texel that stands at any place along an axis of `size` texels.
[[nodiscard]] inline std::uint32_t wrapped(std::int64_t texel, std::uint32_t size, Wrap wrap) {
    const auto n = static_cast<std::int64_t>(size);
    if (texel >= 0 && texel < n)
        return static_cast<std::uint32_t>(texel);  // nearly always, and division is slow
    if (wrap == Wrap::clamp)
        return texel < 0 ? 0 : size - 1;
    const std::int64_t period = wrap == Wrap::mirror ? 2 * n : n;
    std::int64_t r = texel % period;
    if (r < 0)
        r += period;
    return static_cast<std::uint32_t>(r < n ? r : period - 1 - r);
}

// A coordinate in texels, from their corners, for one in [0, 1]. Beyond the bounds a float holds no position
// inside the texture any more. What is no number lands there too.
[[nodiscard]] inline float texel_coordinate(float uv, std::uint32_t size) {
    const float bounded = uv > -1e6f ? std::min(uv, 1e6f) : -1e6f;
    return bounded * static_cast<float>(size) - 0.5f;
}

}  // namespace drtv::map
