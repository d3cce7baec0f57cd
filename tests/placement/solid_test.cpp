// Probes inside solids: moved out by at most half the spacing, or dropped and counted.
#include "tests/placement/analytic_scene.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>

namespace drtv::test {
namespace {

// Ground under the one column at (2, 2).
AnalyticScene one_column() {
    AnalyticScene scene;
    scene.floors = [](glm::vec2 at, std::vector<ColumnHit>& hits) {
        if (at == glm::vec2(2, 2))
            hits.push_back({0, true, false});
    };
    return scene;
}

constexpr glm::ivec3 start(2048, 2048, 1024);

TEST(SolidPlacement, ProbeInASolidIsMovedOutByAtMostHalfTheSpacing) {
    AnalyticScene scene = one_column();
    for (const Box& solid :
         {Box{{0, 0, 0}, {4, 4, 2}}, Box{{1, 1, -3}, {6, 6, 5}}, Box{{-3, 0, -5}, {2.5f, 20, 20}}}) {
        scene.solids = {solid};
        const placement::Placement placed = scene.place(0, 0);
        ASSERT_EQ(placed.probes.size(), 1u);
        EXPECT_EQ(placed.report.moved_out, 1u);
        EXPECT_EQ(placed.report.dropped_in_solid, 0u);
        const Position p = placed.probes[0].position;
        EXPECT_LE(squared_distance(p, start), squared_units(3));
        EXPECT_NE(p, start);
        const glm::vec3 at = placement::metres(p);
        EXPECT_FALSE(glm::all(glm::greaterThan(at, solid.low)) && glm::all(glm::lessThan(at, solid.high)));
    }
}

TEST(SolidPlacement, ProbeDeepInASolidIsDroppedAndCounted) {
    AnalyticScene scene = one_column();
    scene.solids = {{{-50, -50, -50}, {50, 50, 50}}};
    const placement::Placement placed = scene.place(0, 0);
    EXPECT_TRUE(placed.probes.empty());
    EXPECT_EQ(placed.report.dropped_in_solid, 1u);
    EXPECT_EQ(placed.report.moved_out, 0u);
}

TEST(SolidPlacement, QuarterOfTheRaysIsTheLimit) {
    for (const int backs : {6, 7}) {
        const AnalyticScene scene = one_column();
        placement::Surroundings surroundings = scene.surroundings();
        bool asked = false;
        surroundings.backs_met = [&](const glm::vec3& origin,
                                     std::span<const glm::vec3> directions) -> std::size_t {
            EXPECT_EQ(directions.size(), 26u);
            for (const glm::vec3& direction : directions)
                EXPECT_NEAR(glm::dot(direction, direction), 1, 1e-6);
            if (origin != placement::metres(start) || std::exchange(asked, true))
                return 0;
            return static_cast<std::size_t>(backs);
        };
        const auto placed = placement::place_probes({0, 0, {}, {}, {}}, surroundings, {});
        ASSERT_TRUE(placed.has_value());
        EXPECT_EQ(placed->report.moved_out, backs == 7 ? 1u : 0u) << backs << " of 26";
    }
}

TEST(SolidPlacement, BuriedProbeTakesNoPlaceFromAGoodOne) {
    AnalyticScene scene = flat_ground();
    // Posts over the four of the first class around the column at (14, 14).
    for (const glm::vec2 at : {glm::vec2(10, 10), glm::vec2(18, 10), glm::vec2(10, 18), glm::vec2(18, 18)})
        scene.solids.push_back({{at - 1.2f, -30}, {at + 1.2f, 30}});
    const placement::Placement placed = scene.place(0, 0);
    EXPECT_GE(least_squared_distance(placed.probes), squared_units(6));
    EXPECT_TRUE(std::any_of(placed.probes.begin(), placed.probes.end(),
                            [](const PlacedProbe& p) { return p.position == Position(14, 14, 1) * 1024; }));
}

TEST(SolidPlacement, MovedProbeStaysInItsSectorAndYields) {
    AnalyticScene scene = one_column();
    scene.solids = {{{0.0f, -30, -30}, {30, 30, 30}}};  // the only free place within 3 m is across x = 0
    const placement::Placement placed = scene.place(0, 0);
    EXPECT_TRUE(placed.probes.empty());
    EXPECT_EQ(placed.report.dropped_in_solid, 1u);
    EXPECT_TRUE(scene.place(-1, 0).probes.empty());

    scene.solids = {{{0, 0, 0}, {4, 4, 2}}};
    scene.manual = {{2, 2, 8}};  // 7 m above where it stood, but not above where it could go
    EXPECT_EQ(count_of(scene.place(0, 0), Kind::ground), 0u);
}

}  // namespace
}  // namespace drtv::test
