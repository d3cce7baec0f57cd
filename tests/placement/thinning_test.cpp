// At most 255 probes a sector, and what the report says about it.
#include "tests/placement/analytic_scene.h"

#include <gtest/gtest.h>

namespace drtv::test {
namespace {

AnalyticScene tower(int floors) {
    AnalyticScene scene = flat_ground();
    for (int n = 1; n < floors; ++n) {
        const float z_m = 20 * static_cast<float>(n);
        scene.boxes.push_back({{-500, -500, z_m}, {500, 500, z_m + 1}});
    }
    return scene;
}

std::vector<placement::HandPlacedProbe> manual_row(std::size_t count, double z_m) {
    std::vector<placement::HandPlacedProbe> probes;
    for (std::size_t n = 0; n < count; ++n)
        probes.push_back({{0.1 + 0.2 * static_cast<double>(n), 3, z_m}, {}});
    return probes;
}

TEST(Thinning, SectorOfExactlyTheLimitIsLeftAlone) {
    AnalyticScene scene = flat_ground();
    const auto whole = scene.floors;
    scene.floors = [whole](glm::vec2 at, std::vector<ColumnHit>& hits) {
        if (at != glm::vec2(2, 2))
            whole(at, hits);
    };
    const placement::Placement placed = scene.place(0, 0, 4);
    EXPECT_EQ(placed.probes.size(), 255u);
    EXPECT_EQ(placed.report.thinned, 0u);
    EXPECT_EQ(placed.report.used_distance_m, 4);
}

TEST(Thinning, OneTooManyIsOneLessAndIsReported) {
    const placement::Placement placed = flat_ground().place(0, 0, 4);
    EXPECT_EQ(placed.probes.size(), max_probes);
    EXPECT_EQ(placed.report.thinned, 1u);
    EXPECT_EQ(placed.report.used_distance_m, 4);
    EXPECT_GE(min_squared_distance(placed.probes), squared_units(placed.report.used_distance_m));
}

TEST(Thinning, ManyFloorsFitAndNeighboursStayApart) {
    const AnalyticScene scene = tower(9);
    const placement::Placement left = scene.place(0, 0), right = scene.place(1, 0);
    EXPECT_LE(left.probes.size(), max_probes);
    EXPECT_GE(left.probes.size(), 64u) << "thinned far more than needed";
    EXPECT_GT(left.report.thinned, 0u);
    EXPECT_GE(min_squared_distance(left.probes), squared_units(left.report.used_distance_m));
    std::vector<PlacedProbe> both = left.probes;
    both.insert(both.end(), right.probes.begin(), right.probes.end());
    EXPECT_GE(min_squared_distance(both), squared_units(6));
    EXPECT_EQ(keys(left.probes), keys(scene.place(0, 0).probes));
}

TEST(Thinning, ManualProbesCountAndAreNeverGivenUp) {
    AnalyticScene scene = tower(3);
    scene.manual = manual_row(200, -50);
    const placement::Placement placed = scene.place(0, 0);
    EXPECT_EQ(count_of(placed, Kind::manual), 200u);
    EXPECT_LE(placed.probes.size(), max_probes);
    EXPECT_GT(placed.report.thinned, 0u);
}

TEST(Thinning, SectorFullOfManualProbesHasNoRoomForOthers) {
    AnalyticScene scene = tower(2);
    scene.manual = manual_row(255, -50);
    const placement::Placement placed = scene.place(0, 0);
    EXPECT_EQ(placed.probes.size(), 255u);
    EXPECT_EQ(count_of(placed, Kind::manual), 255u);
    EXPECT_GT(placed.report.thinned, 0u);
    scene.manual.pop_back();
    EXPECT_EQ(count_of(scene.place(0, 0), Kind::ground), 1u);
}

TEST(Thinning, MoreManualProbesThanFitAreASentence) {
    AnalyticScene scene = flat_ground();
    scene.manual = manual_row(256, 1);
    const auto placed = placement::place_probes({0, 0, {}, scene.manual, {}, {}}, scene.queries(), {});
    ASSERT_FALSE(placed.has_value());
    EXPECT_NE(placed.error().find("sector (0, 0)"), std::string::npos) << placed.error();
    EXPECT_NE(placed.error().find("256"), std::string::npos) << placed.error();
    EXPECT_TRUE(placement::place_probes({1, 0, {}, scene.manual, {}, {}}, scene.queries(), {}).has_value())
        << "the neighbour is fine";
}

}  // namespace
}  // namespace drtv::test
