// Columns on the 4 m lattice: what proposes a probe, and how high.
#include "placement/candidates.h"
#include "tests/placement/analytic_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>

namespace drtv::test {
namespace {

AnalyticScene room(float ceiling_m) {
    AnalyticScene scene;
    scene.floors = [ceiling_m](glm::vec2, std::vector<ColumnHit>& hits) {
        hits = {{ceiling_m, false, true}, {0, true, false}};
    };
    return scene;
}

TEST(GroundPlacement, FlatGroundCarriesEverySecondColumnEitherWay) {
    const placement::Placement placed = flat_ground(2.5f).place(0, 0);
    EXPECT_EQ(placed.report.candidates, 256u);
    EXPECT_EQ(placed.probes.size(), 64u);  // diagonal neighbours are 5.66 m apart: too near
}

TEST(GroundPlacement, ProbesStandOneMetreAboveOnTheGlobalLattice) {
    for (const auto& [i, j] : {std::pair{0, 0}, {-3, 5}, {-1, -1}, {200, -300}}) {
        const placement::Placement placed = flat_ground(-7.25f).place(i, j);
        EXPECT_FALSE(placed.probes.empty());
        for (const PlacedProbe& p : placed.probes) {
            EXPECT_EQ(p.kind, Kind::ground);
            EXPECT_EQ(p.position.z, -6.25 * 1024);
            EXPECT_EQ(std::abs(p.position.x) % 4096, 2048);
            EXPECT_EQ(std::abs(p.position.y) % 4096, 2048);
        }
    }
}

TEST(GroundPlacement, SlopeIsFollowedToTheUnit) {
    AnalyticScene scene;
    scene.floors = [](glm::vec2 at, std::vector<ColumnHit>& hits) {
        hits = {{at.x * 0.3f + at.y * 0.7f, true, false}};
    };
    const placement::Placement placed = scene.place(1, -2);
    EXPECT_FALSE(placed.probes.empty());
    for (const PlacedProbe& p : placed.probes)
        EXPECT_NEAR(p.position.z, p.position.x * 0.3 + p.position.y * 0.7 + 1024, 0.6)
            << "more than rounding to 2^-10 m";
}

TEST(GroundPlacement, CeilingUnderOneAndAHalfMetresLeavesNone) {
    EXPECT_TRUE(room(1.4f).place(0, 0).probes.empty());
    EXPECT_TRUE(room(1.4999f).place(0, 0).probes.empty());
    EXPECT_FALSE(room(1.5f).place(0, 0).probes.empty());
}

TEST(GroundPlacement, LowCeilingPutsTheProbeHalfway) {
    for (const auto& [ceiling_m, probe_units] :
         {std::pair{1.6f, 819}, {1.75f, 896}, {2.0f, 1024}, {3.0f, 1024}}) {
        const placement::Placement placed = room(ceiling_m).place(0, 0);
        ASSERT_FALSE(placed.probes.empty());
        for (const PlacedProbe& p : placed.probes)
            EXPECT_EQ(p.position.z, probe_units) << "under " << ceiling_m << " m";
    }
}

TEST(GroundPlacement, EveryFloorOfABuildingCarriesProbes) {
    AnalyticScene scene = flat_ground();
    scene.boxes = {{{-100, -100, 10}, {200, 200, 10.5f}}, {{-100, -100, 20}, {200, 200, 20.5f}}};
    const placement::Placement placed = scene.place(0, 0, 6);
    std::map<int, int> of_height;
    for (const PlacedProbe& p : placed.probes)
        ++of_height[p.position.z];
    EXPECT_EQ(placed.report.candidates, 3u * 256u);
    ASSERT_EQ(of_height.size(), 3u);
    EXPECT_TRUE(of_height.contains(1024) && of_height.contains(11 * 1024 + 512) &&
                of_height.contains(21 * 1024 + 512));
}

TEST(GroundPlacement, TopOfASolidInsideAnotherProposesNothing) {
    AnalyticScene scene;
    scene.boxes = {{{-100, -100, -1}, {200, 200, 3}}, {{-100, -100, 2}, {200, 200, 9}}};
    const placement::Placement placed = scene.place(0, 0);
    EXPECT_EQ(placed.report.candidates, 256u);
    for (const PlacedProbe& p : placed.probes)
        EXPECT_EQ(p.position.z, 10 * 1024);
}

TEST(GroundPlacement, StackedBoxesThatTouchProposeOnTopOnly) {
    for (const bool swapped : {false, true}) {
        AnalyticScene scene;
        scene.boxes = {{{-100, -100, 0}, {200, 200, 4}}, {{-100, -100, 4}, {200, 200, 8}}};
        if (swapped)
            std::swap(scene.boxes[0], scene.boxes[1]);
        for (const PlacedProbe& p : scene.place(0, 0).probes)
            EXPECT_EQ(p.position.z, 9 * 1024);
        EXPECT_EQ(scene.place(0, 0).report.candidates, 256u);
    }
}

TEST(GroundPlacement, DownFacingSurfacesProposeNothing) {
    AnalyticScene scene;
    scene.floors = [](glm::vec2, std::vector<ColumnHit>& hits) { hits = {{5, false, true}}; };
    EXPECT_EQ(scene.place(0, 0).report.candidates, 0u);
}

TEST(GroundPlacement, ThinTwoSidedRoofCarriesAndCovers) {
    AnalyticScene scene;
    scene.floors = [](glm::vec2, std::vector<ColumnHit>& hits) {
        hits = {{8, true, true}, {0, true, false}};
    };
    EXPECT_EQ(scene.place(0, 0).report.candidates, 2u * 256u);
}

TEST(GroundPlacement, DoubleHitsAtSharedEdgesAreHarmless) {
    AnalyticScene doubled;
    doubled.floors = [](glm::vec2 at, std::vector<ColumnHit>& hits) {
        const float z_m = at.x * 0.1f;
        hits = {{z_m + 12, true, true},
                {z_m + 12, true, true},
                {z_m + 12, true, true},
                {z_m, true, false},
                {std::nextafter(z_m, -1000.0f), true, false}};
    };
    AnalyticScene once;
    once.floors = [](glm::vec2 at, std::vector<ColumnHit>& hits) {
        hits = {{at.x * 0.1f + 12, true, true}, {at.x * 0.1f, true, false}};
    };
    const placement::Placement placed = doubled.place(0, 0);
    EXPECT_EQ(placed.report.candidates, 2u * 256u);
    EXPECT_EQ(keys(placed.probes).size(), keys(once.place(0, 0).probes).size());
    for (std::size_t n = 0; n < placed.probes.size(); ++n)
        EXPECT_LE(squared_distance(placed.probes[n].position, once.place(0, 0).probes[n].position), 1);
}

TEST(GroundPlacement, ExactlyTheMinimalDistanceIsFarEnough) {
    EXPECT_EQ(flat_ground().place(0, 0, 8).probes.size(), 64u);
    EXPECT_LT(flat_ground().place(0, 0, 8.01f).probes.size(), 64u);
}

TEST(LatticeClass, ColumnsOfOneClassNeverCompete) {
    for (const float distance_m : {1.0f, 3.0f, 4.0f, 4.01f, 6.0f, 8.0f, 9.0f, 14.0f, 33.0f}) {
        const std::uint32_t stride = placement::lattice_stride(4, distance_m);
        EXPECT_GE(static_cast<float>(stride) * 4, distance_m);
        EXPECT_TRUE(stride == 1 || static_cast<float>(stride) * 2 < distance_m) << "not the smallest";
        std::map<std::uint32_t, std::pair<int, int>> seen;
        const int n = static_cast<int>(stride);
        for (int b = -n; b < n; ++b) {
            for (int a = -n; a < n; ++a) {
                const std::uint32_t c = placement::lattice_class_of(a, b, stride);
                EXPECT_LT(c, stride * stride);
                const auto [entry, added] = seen.try_emplace(c, a, b);
                EXPECT_TRUE(added ||
                            ((a - entry->second.first) % n == 0 && (b - entry->second.second) % n == 0));
            }
        }
        EXPECT_EQ(seen.size(), stride * stride);
    }
}

}  // namespace
}  // namespace drtv::test
