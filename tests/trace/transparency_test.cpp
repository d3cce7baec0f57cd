// Masked texels let rays through, in every kind of query.
#include "tests/trace/scenes.h"

#include <gtest/gtest.h>

namespace drtv::test {
namespace {

// The left half (x < 0) of a level square is masked away; below it lies a full one.
std::vector<Thing> leaf_over_ground(const std::string& role) {
    Thing leaf = thing_of(level_square(2, 3), glm::vec3(1), role);
    leaf.material.texture = 0;
    leaf.material.mask_cutoff = 0.5;
    return {leaf, thing_of(level_square(50), glm::vec3(0.5f))};
}

constexpr glm::vec3 down(0, 0, -1);

TEST(Transparency, MaskedTexelLetsTheClosestHitThrough) {
    const auto scene = scene_of(leaf_over_ground("vegetation"));
    EXPECT_FLOAT_EQ(scene->closest({{1.5f, 0.5f, 5}, down, 50})->distance_m, 2);
    EXPECT_FLOAT_EQ(scene->closest({{-1.5f, 0.5f, 5}, down, 50})->distance_m, 5);
    EXPECT_TRUE(scene->closest({{1.5f, 0.5f, 1}, {0, 0, 1}, 50}));
    EXPECT_FALSE(scene->closest({{-1.5f, 0.5f, 1}, {0, 0, 1}, 50}));
}

TEST(Transparency, MaskedTexelDoesNotOcclude) {
    const auto scene = scene_of(leaf_over_ground("vegetation"));
    EXPECT_TRUE(scene->occluded({{1.5f, 0.5f, 5}, down, 4}));
    EXPECT_FALSE(scene->occluded({{-1.5f, 0.5f, 5}, down, 4}));
    EXPECT_TRUE(scene->occluded({{-1.5f, 0.5f, 5}, down, 6}));
}

TEST(Transparency, MaskedTexelIsNoCrossingOfAColumn) {
    const auto scene = scene_of(leaf_over_ground("static"));
    std::vector<placement::ColumnHit> hits;
    scene->column({1.5f, 0.5f}, hits);
    EXPECT_EQ(hits.size(), 2u);
    scene->column({-1.5f, 0.5f}, hits);
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_EQ(hits[0].z_m, 0);
}

TEST(Transparency, ManyMaskedLayersAreAllPassed) {
    std::vector<Thing> things = leaf_over_ground("vegetation");
    for (int n = 0; n < 200; ++n) {
        things.push_back(things[0]);
        things.back().shape = level_square(2, 4 + 0.125f * static_cast<float>(n));
    }
    const auto scene = scene_of(things);
    EXPECT_FLOAT_EQ(scene->closest({{-1.5f, 0.5f, 64}, down, 100})->distance_m, 64);
    EXPECT_FALSE(scene->occluded({{-1.5f, 0.5f, 64}, down, 63}));
}

TEST(Transparency, UnmaskedMaterialIgnoresItsAlpha) {
    std::vector<Thing> things = leaf_over_ground("static");
    things[0].material.mask_cutoff.reset();
    const auto scene = scene_of(things);
    EXPECT_FLOAT_EQ(scene->closest({{-1.5f, 0.5f, 5}, down, 50})->distance_m, 2);
    EXPECT_TRUE(scene->occluded({{-1.5f, 0.5f, 5}, down, 4}));
}

}  // namespace
}  // namespace drtv::test
