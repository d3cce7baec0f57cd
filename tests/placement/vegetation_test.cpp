// The vegetation's own pass: 8 m lattice, combined boxes, probes on top.
#include "tests/placement/analytic_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace drtv::test {
namespace {

std::vector<int> heights(const AnalyticScene& scene) {
    std::vector<int> result;
    for (const PlacedProbe& p : scene.place(0, 0).probes) {
        EXPECT_EQ(p.kind, Kind::vegetation);
        EXPECT_EQ(std::abs(p.position.x) % 8192, 4096);
        EXPECT_EQ(std::abs(p.position.y) % 8192, 4096);
        result.push_back(p.position.z / 1024);
    }
    std::sort(result.begin(), result.end());
    return result;
}

Box column_box(float low_m, float high_m) {
    return {{9, 9, low_m}, {15, 15, high_m}};
}

TEST(VegetationPlacement, TreeCarriesAProbeOnItsBox) {
    AnalyticScene scene;
    scene.vegetation = {column_box(0, 10)};
    EXPECT_EQ(heights(scene), std::vector<int>{11});
}

TEST(VegetationPlacement, TreeBetweenTheColumnsCarriesNone) {
    AnalyticScene scene;
    scene.vegetation = {{{13, 13, 0}, {19, 19, 10}}};
    EXPECT_TRUE(heights(scene).empty());
}

TEST(VegetationPlacement, OverlappingBoxesAreOneThicket) {
    AnalyticScene scene;
    scene.vegetation = {column_box(0, 10), column_box(8, 14), column_box(2, 5), column_box(14, 16),
                        column_box(40, 44)};
    EXPECT_EQ(heights(scene), (std::vector<int>{17, 45}));
    std::sort(scene.vegetation.begin(), scene.vegetation.end(),
              [](const Box& a, const Box& b) { return a.high.z > b.high.z; });
    EXPECT_EQ(heights(scene), (std::vector<int>{17, 45}));
}

TEST(VegetationPlacement, GroundGoesBeforeVegetation) {
    AnalyticScene scene = flat_ground();
    scene.vegetation = {{{0, 0, 0}, {64, 64, 2}}};
    EXPECT_EQ(count_of(scene.place(0, 0), Kind::vegetation), 0u) << "2 m over the ground's probes";
    EXPECT_EQ(scene.place(0, 0).report.candidates, 256u + 64u);
    scene.vegetation[0].high.z = 9;
    EXPECT_EQ(count_of(scene.place(0, 0), Kind::vegetation), 64u);
}

}  // namespace
}  // namespace drtv::test
