#include "bakerd/map/texture_alpha.h"

#include "bakerd/map/texel.h"

#include <algorithm>
#include <cmath>

namespace drtv::map {
namespace {

std::uint32_t blocks_along(std::uint32_t texels) {
    return (texels + alpha_block_texels - 1) / alpha_block_texels;
}

// One of a picture's axes.
struct Axis {
    std::uint32_t size;
    Wrap wrap;
};

std::int64_t texel_before(float uv, std::uint32_t size) {
    return static_cast<std::int64_t>(std::floor(texel_coordinate(uv, size)));
}

// Blocks along an axis that samples within [from, to] can read; all of them where the picture repeats inside.
std::vector<bool> touched_blocks(Axis axis, float from, float to) {
    const std::int64_t first = texel_before(from, axis.size) - 1;
    const std::int64_t last = texel_before(to, axis.size) + 2;
    const std::uint32_t count = blocks_along(axis.size);
    if (last - first >= std::int64_t{2} * axis.size)
        return std::vector<bool>(count, true);
    std::vector<bool> touched(count, false);
    for (std::int64_t texel = first; texel <= last; ++texel)
        touched[wrapped(texel, axis.size, axis.wrap) / alpha_block_texels] = true;
    return touched;
}

}  // namespace

std::vector<AlphaRange> alpha_blocks_of(const Texture& texture) {
    const std::uint32_t columns = blocks_along(texture.width);
    const std::uint32_t rows = blocks_along(texture.height);
    std::vector<AlphaRange> blocks(std::size_t{columns} * rows, {255, 0});
    for (std::uint32_t y = 0; y < texture.height; ++y) {
        AlphaRange* row = &blocks[std::size_t{y / alpha_block_texels} * columns];
        for (std::uint32_t x = 0; x < texture.width; ++x) {
            AlphaRange& block = row[x / alpha_block_texels];
            const std::uint8_t alpha = bytes_of(texture, {x, y})[3];
            block.low = std::min(block.low, alpha);
            block.high = std::max(block.high, alpha);
        }
    }
    return blocks;
}

AlphaRange alpha_range(const Texture& texture, glm::vec2 low, glm::vec2 high) {
    const std::vector<bool> across = touched_blocks({texture.width, texture.wrap_u}, low.x, high.x);
    const std::vector<bool> down = touched_blocks({texture.height, texture.wrap_v}, low.y, high.y);
    const auto columns = static_cast<std::uint32_t>(across.size());
    const auto rows = static_cast<std::uint32_t>(down.size());
    AlphaRange range{255, 0};
    for (std::uint32_t row = 0; row < rows; ++row) {
        if (!down[row])
            continue;
        const AlphaRange* blocks = &texture.alpha_blocks[std::size_t{row} * columns];
        for (std::uint32_t column = 0; column < columns; ++column) {
            if (!across[column])
                continue;
            const AlphaRange& block = blocks[column];
            range = {std::min(range.low, block.low), std::max(range.high, block.high)};
            if (range.low == 0 && range.high == 255)
                return range;
        }
    }
    return range;
}

}  // namespace drtv::map
