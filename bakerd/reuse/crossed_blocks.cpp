#include "bakerd/reuse/crossed_blocks.h"

#include <glm/common.hpp>

#include <algorithm>
#include <bit>

namespace drtv::reuse {
namespace {

// Cells of the grid, both ends counted.
struct CellRange {
    glm::ivec3 first;
    glm::ivec3 last;
};

// REQUIRES: the box overlaps the grid.
CellRange cells_of(const Bounds& box, const FootprintGrid& grid) {
    const glm::vec3 cell(grid.cell_m, grid.cell_m, grid.layer_m);
    const glm::vec3 end(grid.columns - 1, grid.rows - 1, grid.layers - 1);
    const auto cell_at = [&](const glm::vec3& place) {
        return glm::ivec3(glm::clamp(glm::floor((place - grid.low()) / cell), glm::vec3(0), end));
    };
    return {cell_at(box.low), cell_at(box.high)};
}

}  // namespace

CrossedBlocks::CrossedBlocks(const Footprint& footprint)
    : footprint_(footprint), counted_(footprint.grid.block_count(), false) {}

std::array<float, quarter_count> CrossedBlocks::add(std::span<const Bounds> boxes) {
    const FootprintGrid& grid = footprint_.grid;
    std::array<float, quarter_count> shares{};
    for (const Bounds& box : boxes) {
        // Above and below the grid rays go unseen.
        if (box.low.z < grid.low().z || box.high.z > grid.high().z)
            shares.fill(unbounded);
        if (!overlap(box, {grid.low(), grid.high()}))
            continue;
        const auto [first, last] = cells_of(box, grid);
        const std::uint64_t layers = layers_between(first.z, last.z);
        for (std::int32_t j = first.y; j <= last.y; ++j) {
            for (std::int32_t i = first.x; i <= last.x; ++i) {
                std::uint64_t crossed = footprint_.crossed[grid.column(i, j)] & layers;
                for (; crossed != 0; crossed &= crossed - 1) {
                    const std::size_t block = grid.block(i, j, std::countr_zero(crossed));
                    if (counted_[block])
                        continue;
                    counted_[block] = true;
                    for (std::size_t quarter = 0; quarter < quarter_count; ++quarter)
                        shares[quarter] += weight_of_code(footprint_.weight(block, quarter));
                }
            }
        }
    }
    // Local transfer is of all probes together, whichever quarter its rays began in.
    if (footprint_.without_bounds)
        shares.fill(std::ranges::max(shares));
    return shares;
}

}  // namespace drtv::reuse
