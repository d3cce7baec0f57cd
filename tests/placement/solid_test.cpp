// Probes inside solids: moved out by at most half the spacing, or dropped and counted.
#include "tests/placement/analytic_scene.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

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

// What the looks of the one column's probe meet.
placement::SceneQueries meeting(const AnalyticScene& scene, const placement::Met& met) {
    placement::SceneQueries queries = scene.queries();
    queries.first_met = [met](const glm::vec3& origin, std::span<const placement::Look> looks, std::size_t) {
        EXPECT_EQ(looks.size(), 49u);
        for (const placement::Look& look : looks) {
            EXPECT_NEAR(glm::dot(look.direction, look.direction), 1, 1e-6);
            EXPECT_GT(look.direction.z, 0) << "upward";
        }
        return origin == placement::metres(start) ? met : placement::Met{0, 49, std::nullopt};
    };
    return queries;
}

placement::Placement place_one(const placement::SceneQueries& queries) {
    return placement::place_probes({0, 0, {}, {}, {}, {}}, queries, {}).value();
}

TEST(SolidPlacement, FourInFiveBacksAndNoEscapeIsTheLimit) {
    const AnalyticScene scene = one_column();
    for (const auto& [backs, misses, solid] :
         {std::tuple(39, 0, true), {49, 0, true}, {38, 0, false}, {48, 1, false}, {0, 0, false}}) {
        const placement::Met met{static_cast<std::size_t>(backs), static_cast<std::size_t>(misses), 7};
        const placement::Placement placed = place_one(meeting(scene, met));
        EXPECT_EQ(placed.report.moved_out, solid ? 1u : 0u) << backs << " backs, " << misses << " escape";
        ASSERT_EQ(placed.probes.size(), 1u);
        EXPECT_EQ(placed.probes[0].moved, solid);
    }
}

TEST(SolidPlacement, AProbeInAWallGoesToOneOfItsSides) {
    const AnalyticScene scene = one_column();
    placement::SceneQueries queries = scene.queries();
    // A sheet in the plane x = 2.
    queries.wall_within = [](const glm::vec3& point, float within_m) {
        return std::abs(point.x - 2) < within_m ? std::optional<placement::Thing>(3) : std::nullopt;
    };
    queries.sides = [](const glm::vec3& from, const glm::vec3& to) {
        std::vector<placement::Side> sides;
        if ((from.x - 2) * (to.x - 2) < 0)
            sides.push_back({0.02f, false, true});
        return sides;
    };
    const placement::Placement placed = place_one(queries);
    ASSERT_EQ(placed.probes.size(), 1u);
    EXPECT_EQ(placed.report.moved_out, 1u);
    EXPECT_NE(placed.probes[0].position.x, start.x);
}

// A cellar's floor below, a front; beside the solid the ground rises, a front as well.
TEST(SolidPlacement, NoProbeIsPushedThroughAFront) {
    AnalyticScene scene = one_column();
    scene.solids = {{{0, -50, -50}, {4, 50, 50}}};
    placement::SceneQueries queries = scene.queries();
    EXPECT_EQ(place_one(queries).report.moved_out, 1u);
    queries.sides = [&](const glm::vec3& from, const glm::vec3& to) {
        std::vector<placement::Side> sides = scene.sides(from, to);
        sides.push_back({0.5f, true, false});
        return sides;
    };
    EXPECT_EQ(place_one(queries).report.dropped_in_solid, 1u);
    EXPECT_EQ(place_one(queries).dropped_in, std::vector<placement::Thing>{0});
}

TEST(SolidPlacement, AHandPlacedProbeInASolidStaysAndIsNamed) {
    AnalyticScene scene;
    scene.boxes = {{{0, 0, 0}, {9, 9, 9}}};
    scene.manual = manual_at({{5, 5, 5}, {20, 20, 5}});
    const placement::Placement placed = scene.place(0, 0);
    EXPECT_EQ(count_of(placed, Kind::manual), 2u);
    ASSERT_EQ(placed.buried_manual.size(), 1u);
    EXPECT_EQ(placed.buried_manual[0].position, Position(5, 5, 5) * 1024);
    EXPECT_EQ(placed.buried_manual[0].stand, placement::Stand::in_solid);
}

TEST(SolidPlacement, BuriedProbeTakesNoPlaceFromAGoodOne) {
    AnalyticScene scene = flat_ground();
    // Posts over the four of the first class around the column at (14, 14).
    for (const glm::vec2 at : {glm::vec2(10, 10), glm::vec2(18, 10), glm::vec2(10, 18), glm::vec2(18, 18)})
        scene.solids.push_back({{at - 1.2f, -30}, {at + 1.2f, 30}});
    const placement::Placement placed = scene.place(0, 0);
    EXPECT_GE(min_squared_distance(placed.probes), squared_units(6));
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
    scene.manual = manual_at({{2, 2, 8}});  // 7 m above where it stood, but not above where it could go
    EXPECT_EQ(count_of(scene.place(0, 0), Kind::ground), 0u);
}

}  // namespace
}  // namespace drtv::test
