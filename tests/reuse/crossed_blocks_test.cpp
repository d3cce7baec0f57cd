#include "bakerd/reuse/crossed_blocks.h"

#include "bakerd/bake/settings_key.h"

#include <gtest/gtest.h>

namespace drtv::test {
namespace {

// One cell in which rays of probes in the first quarter were seen, with a weight of 2^-8.
struct OneCell {
    reuse::Footprint footprint;
    map::Bounds box;

    OneCell() {
        reuse::FootprintGrid& grid = footprint.grid;
        grid = reuse::footprint_grid({0, 0}, 100, 0, 20);
        footprint.crossed.assign(grid.column_count(), 0);
        footprint.weights.assign(grid.block_count() * reuse::quarter_count, 0);
        footprint.crossed[grid.column(2, 3)] = 1u << 1;
        footprint.weights[grid.block(2, 3, 1) * reuse::quarter_count] = reuse::weight_code(0x1p-8f);
        const glm::vec3 cell(grid.cell_m, grid.cell_m, grid.layer_m);
        const glm::vec3 middle = grid.low() + cell * glm::vec3(2.5f, 3.5f, 1.5f);
        box = {middle - 0.5f, middle + 0.5f};
    }
};

using ByQuarter = std::array<float, reuse::quarter_count>;

TEST(CrossedBlocks, WeighForTheQuarterWhoseRaysCrossedThem) {
    const OneCell one;
    reuse::CrossedBlocks blocks(one.footprint);
    EXPECT_EQ(blocks.add({&one.box, 1}), (ByQuarter{0x1p-8f, 0, 0, 0}));
}

TEST(CrossedBlocks, CountOnce) {
    const OneCell one;
    reuse::CrossedBlocks blocks(one.footprint);
    static_cast<void>(blocks.add({&one.box, 1}));
    EXPECT_EQ(blocks.add({&one.box, 1}), ByQuarter{});
}

TEST(CrossedBlocks, WhereNothingCrossedWeighNothing) {
    OneCell one;
    one.box.low.x += static_cast<float>(one.footprint.grid.cell_m);
    one.box.high.x += static_cast<float>(one.footprint.grid.cell_m);
    reuse::CrossedBlocks blocks(one.footprint);
    EXPECT_EQ(blocks.add({&one.box, 1}), ByQuarter{});
}

// Of local transfer a ray of one probe's serves all others.
TEST(CrossedBlocks, WithoutBoundsWeighForAllProbes) {
    OneCell one;
    one.footprint.without_bounds = true;
    reuse::CrossedBlocks blocks(one.footprint);
    EXPECT_EQ(blocks.add({&one.box, 1}), (ByQuarter{0x1p-8f, 0x1p-8f, 0x1p-8f, 0x1p-8f}));
}

TEST(CrossedBlocks, AboveTheGridNothingIsKnown) {
    OneCell one;
    one.box.high.z = one.footprint.grid.high().z + 1;
    reuse::CrossedBlocks blocks(one.footprint);
    EXPECT_GE(blocks.add({&one.box, 1})[3], reuse::unbounded);
}

TEST(ResultsKey, FollowsFromTheSettings) {
    const settings::BakeSettings base;
    settings::BakeSettings other = base;
    other.rays = 17;
    EXPECT_EQ(reuse::results_key(base), reuse::results_key(settings::BakeSettings{}));
    EXPECT_NE(reuse::results_key(base), reuse::results_key(other));
    EXPECT_NE(reuse::results_key(base), bake::settings_key(base));
}

}  // namespace
}  // namespace drtv::test
