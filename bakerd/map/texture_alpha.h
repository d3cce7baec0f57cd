// Bounds of a picture's alpha over a piece of it, from the bounds of its blocks.
#pragma once

#include "bakerd/map/map.h"

#include <cstdint>
#include <vector>

namespace drtv::map {

inline constexpr std::uint32_t alpha_block_texels = 8;  // along each side

// The range of each block, row by row.
[[nodiscard]] std::vector<AlphaRange> alpha_blocks_of(const Texture& texture);

// Bounds of alpha, in [0, 255], over every bilinear sample at uvs within [low, high]. REQUIRES:
// `alpha_blocks` is filled.
[[nodiscard]] AlphaRange alpha_range(const Texture& texture, glm::vec2 low, glm::vec2 high);

}  // namespace drtv::map
