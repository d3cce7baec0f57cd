// Objects over 96 m are cut to the reach and put into world space; rays must not see the difference.
#include "tests/trace/scenes.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace drtv::test {
namespace {

using trace::Hit;
using trace::Ray;

// Floats of some hundred metres, transformed before or during the trace.
constexpr float distance_tolerance_m = 1e-3f;
constexpr float normal_tolerance = 1e-4f;
// Of rays that end at a ridge or a rim, rounding decides which triangle they meet.
constexpr double edge_share = 2e-3;

constexpr int cells = 24;
constexpr float cell_m = 10;

// Hills of 240 m x 240 m.
struct Hills {
    std::array<std::array<float, cells + 1>, cells + 1> heights{};

    explicit Hills(std::mt19937& random) {
        for (auto& row : heights) {
            for (float& height : row)
                height = between(random, -6, 6);
        }
    }
    [[nodiscard]] glm::vec3 corner(int x, int y) const {
        return {static_cast<float>(x - cells / 2) * cell_m, static_cast<float>(y - cells / 2) * cell_m,
                heights[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)]};
    }
    [[nodiscard]] Shape part(int x0, int y0, int width) const {
        Shape shape;
        for (int y = y0; y < y0 + width; ++y) {
            for (int x = x0; x < x0 + width; ++x) {
                const auto first = static_cast<std::uint32_t>(shape.positions.size());
                for (const glm::vec3& p :
                     {corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)})
                    shape.positions.push_back(p);
                for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u})
                    shape.indices.push_back(first + k);
            }
        }
        return shape;
    }
    [[nodiscard]] std::vector<Thing> in_parts(int width, const glm::dmat4& world_from_shape) const {
        std::vector<Thing> things;
        for (int y = 0; y < cells; y += width) {
            for (int x = 0; x < cells; x += width) {
                things.push_back(thing_of(part(x, y, width)));
                things.back().world_from_shape = world_from_shape;
            }
        }
        return things;
    }
};

std::array<glm::vec3, 3> corners_of(const trace::Scene& scene, const Hit& hit) {
    const map::Primitive& primitive = scene.map().meshes[scene.object_of(hit).mesh].primitives[hit.primitive];
    const glm::uvec3& t = primitive.triangles[hit.triangle];
    return {primitive.positions[t.x], primitive.positions[t.y], primitive.positions[t.z]};
}

struct Placement {
    const char* name;
    glm::dmat4 world_from_shape;
};

std::vector<Placement> placements() {
    const glm::dmat4 one(1);
    return {{"as it is", one},
            {"moved and turned",
             glm::rotate(glm::translate(one, glm::dvec3(300.3, -200.7, 12.1)), 0.7, glm::dvec3(0.2, 0.1, 1))},
            {"mirrored", glm::scale(one, glm::dvec3(-1, 1, 1))},
            {"turned, scaled unevenly and mirrored",
             glm::scale(
                 glm::rotate(glm::translate(one, glm::dvec3(-77.7, 31.3, -9)), 2.1, glm::dvec3(0.3, -0.2, 1)),
                 glm::dvec3(1.1, -0.9, 1.7))}};
}

TEST(LargeObject, IsMetAsTheSameThingInSmallPartsIs) {
    for (const auto& [name, world_from_shape] : placements()) {
        SCOPED_TRACE(name);
        std::mt19937 random(1);
        const Hills hills(random);
        const auto large = scene_of(hills.in_parts(cells, world_from_shape)),
                   small = scene_of(hills.in_parts(4, world_from_shape));
        ASSERT_EQ(large->object_count(), 1u);
        ASSERT_EQ(small->object_count(), 36u);
        int hits = 0, backs = 0, others = 0;
        for (int n = 0; n < 8000; ++n) {
            const glm::dvec4 from(between(random, -120, 120), between(random, -120, 120),
                                  between(random, -30, 30), 1),
                to(between(random, -119, 119), between(random, -119, 119), between(random, -6, 6), 1);
            const glm::vec3 origin(world_from_shape * from);
            const Ray ray{origin, glm::normalize(glm::vec3(world_from_shape * to) - origin), 600};
            const auto a = large->closest(ray), b = small->closest(ray);
            if (a.has_value() != b.has_value() ||
                (a && std::abs(a->distance_m - b->distance_m) > distance_tolerance_m) ||
                (a && corners_of(*large, *a) != corners_of(*small, *b))) {
                ++others;
                continue;
            }
            EXPECT_EQ(large->occluded(ray), a.has_value());
            if (!a)
                continue;
            ++hits;
            backs += a->front ? 0 : 1;
            ASSERT_EQ(a->front, b->front) << "ray " << n;
            EXPECT_LT(glm::distance(a->normal, b->normal), normal_tolerance);
            EXPECT_LT(glm::dot(a->normal, ray.direction), 0);
            EXPECT_NEAR(a->double_area_m2, b->double_area_m2, b->double_area_m2 * 1e-4f);
            EXPECT_NEAR(a->u, b->u, 1e-3f);
            EXPECT_NEAR(a->v, b->v, 1e-3f);
        }
        EXPECT_LT(others, 8000 * edge_share);
        EXPECT_GT(hits, 5000);
        EXPECT_GT(backs, 1000);
    }
}

TEST(LargeObject, IsCrossedByColumnsAsTheSameThingInSmallPartsIs) {
    for (const auto& [name, world_from_shape] : placements()) {
        SCOPED_TRACE(name);
        std::mt19937 random(2);
        const Hills hills(random);
        const auto large = scene_of(hills.in_parts(cells, world_from_shape)),
                   small = scene_of(hills.in_parts(4, world_from_shape));
        std::vector<placement::ColumnHit> a, b;
        int others = 0, compared = 0;
        for (int n = 0; n < 2000; ++n) {
            const glm::dvec3 at(world_from_shape *
                                glm::dvec4(between(random, -110, 110), between(random, -110, 110), 0, 1));
            large->column(glm::vec2(at), a);
            small->column(glm::vec2(at), b);
            if (a.size() != b.size()) {
                ++others;
                continue;
            }
            for (std::size_t k = 0; k < a.size(); ++k) {
                ++compared;
                EXPECT_NEAR(a[k].z_m, b[k].z_m, distance_tolerance_m);
                EXPECT_EQ(std::pair(a[k].up_facing, a[k].down_facing),
                          std::pair(b[k].up_facing, b[k].down_facing));
                EXPECT_NE(a[k].up_facing, a[k].down_facing);
            }
        }
        EXPECT_LT(others, 2000 * edge_share);
        EXPECT_GT(compared, 1500);
    }
}

TEST(LargeObject, IsCutToWhatLiesWithinReach) {
    std::mt19937 random(3);
    const Hills hills(random);
    for (const auto& [name, world_from_shape] : {placements()[0], placements()[2]}) {
        SCOPED_TRACE(name);
        const auto map = map_of(hills.in_parts(cells, world_from_shape));
        const trace::WorldRectangle region{glm::vec2(-15), glm::vec2(5)};
        const float reach_m = 22;  // up to -37 and 27: into the cells that end at -40 and 30
        const auto cut = scene_of(map, region, reach_m), whole = scene_of(map);
        ASSERT_EQ(cut->object_count(), 1u);
        int within = 0, beyond = 0;
        for (int n = 0; n < 4000; ++n) {
            const glm::vec2 at(between(random, -119, 119), between(random, -119, 119));
            const Ray down{{at, 50}, {0, 0, -1}, 100};
            const auto a = cut->closest(down), b = whole->closest(down);
            ASSERT_TRUE(b) << at.x << ", " << at.y;
            const auto inside = [&](float margin_m) {
                return std::min(at.x, at.y) > -37 - margin_m && std::max(at.x, at.y) < 27 + margin_m;
            };
            if (inside(0)) {
                ++within;
                ASSERT_TRUE(a) << at.x << ", " << at.y;
                EXPECT_EQ(std::tie(a->distance_m, a->u, a->v, a->triangle, a->front, a->normal),
                          std::tie(b->distance_m, b->u, b->v, b->triangle, b->front, b->normal));
            } else if (!inside(cell_m)) {
                ++beyond;
                EXPECT_FALSE(a) << at.x << ", " << at.y;
                EXPECT_FALSE(cut->occluded(down));
                EXPECT_EQ(cut->crossings(down), 0u);
            }
        }
        EXPECT_GT(within, 150);
        EXPECT_GT(beyond, 2000);
    }
}

TEST(LargeObject, KeepsItsInstanceAndPlaceAmongOthers) {
    std::mt19937 random(4);
    const Hills hills(random);
    std::vector<Thing> things = hills.in_parts(cells, glm::dmat4(1));
    for (int n = 0; n < 5; ++n)
        things.push_back(thing_of(box({-100 + 40 * n, 0, 20}, {-95 + 40 * n, 5, 25}),
                                  glm::vec3(0.1f * static_cast<float>(n))));
    things.push_back(things[0]);
    things.back().world_from_shape = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -40));
    const auto scene = scene_of(things);
    ASSERT_EQ(scene->object_count(), 7u);
    int large = 0;
    for (int n = 0; n < 4000; ++n) {
        const Ray ray{{between(random, -110, 110), between(random, -110, 110), 60}, {0, 0, -1}, 200};
        const auto hit = scene->closest(ray);
        ASSERT_TRUE(hit);
        const map::Bounds& bounds = scene->object_of(*hit).bounds;
        const float z_m = ray.origin.z - hit->distance_m;
        EXPECT_TRUE(z_m >= bounds.low.z - distance_tolerance_m && z_m <= bounds.high.z + distance_tolerance_m)
            << z_m;
        EXPECT_TRUE(ray.origin.x >= bounds.low.x - distance_tolerance_m &&
                    ray.origin.x <= bounds.high.x + distance_tolerance_m);
        large += bounds.high.x - bounds.low.x > 128 ? 1 : 0;
        EXPECT_GE(scene->crossings(ray), 2u);  // both hills
    }
    EXPECT_GT(large, 3000);
}

}  // namespace
}  // namespace drtv::test
