// Pictures: decoding PNG and JPEG, sampling albedo and alpha.
#pragma once

#include "bakerd/map/map.h"

#include <span>
#include <string>

#include <tl/expected.hpp>

namespace drtv::map {

// Decodes PNG or JPEG into an RGBA texture (wrapping left at repeat, digest empty). Sentence on failure.
[[nodiscard]] tl::expected<Texture, std::string> decode_texture(std::span<const std::uint8_t> encoded);

// Fills `mips` and, unless coverage is whole, `alpha_blocks`. REQUIRES: size, wrapping, coverage and rgba are
// final.
void prefilter(Texture& texture);

inline constexpr std::uint32_t alpha_block_texels = 8;  // along each side

// Bounds of alpha, in [0, 255], over every bilinear sample at uvs within [low, high].
[[nodiscard]] AlphaRange alpha_range(const Texture& texture, glm::vec2 low, glm::vec2 high);

// The largest linear colour of any texel that is there at all.
[[nodiscard]] glm::vec3 brightest(const Texture& texture);

// The largest of any texel: no sample is brighter, of whatever level, but for the last digit.
[[nodiscard]] glm::vec3 brightest_of_all(const Texture& texture);

// Bilinear sample at uv of the mip level, at most the last one: the mean linear colour of what is there, as
// wide as one texel of that level. Level 0 is the picture itself. Any uv is safe.
[[nodiscard]] glm::vec3 sample_filtered(const Texture& texture, glm::vec2 uv, std::uint32_t level);

// The alpha of `sample`, without its colour.
[[nodiscard]] float sample_alpha(const Texture& texture, glm::vec2 uv);

// Bilinear sample at uv: linear colour, alpha in w. Any uv is safe.
[[nodiscard]] glm::vec4 sample(const Texture& texture, glm::vec2 uv);

}  // namespace drtv::map
