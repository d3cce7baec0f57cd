// The closest hit against a loop over all triangles in double.
#include "tests/trace/scenes.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>

namespace drtv::test {
namespace {

using trace::Hit;
using trace::Ray;

// Float rays over some tens of metres: a few units in the last place of the coordinates.
constexpr double distance_tolerance_m = 2e-4;
// A ray nearer to a triangle's edge than this share of it may go either way.
constexpr double edge_tolerance = 1e-4;

struct SlowHit {
    double distance_m = std::numeric_limits<double>::infinity();
    glm::dvec3 normal{};  // of the counter-clockwise side in the map's object space
    bool sure = true;     // no triangle was grazed or met near its edge on the way
};

SlowHit slow_closest(const map::Map& map, const Ray& ray) {
    SlowHit best;
    double unsure_m = std::numeric_limits<double>::infinity();
    for (const map::Object& object : map.objects) {
        const glm::dmat4x3 world_from_object(object.world_from_object);
        const double side = glm::determinant(glm::dmat3(world_from_object)) < 0 ? -1 : 1;
        for (const map::Primitive& primitive : map.meshes[object.mesh].primitives) {
            for (const glm::uvec3& t : primitive.triangles) {
                const glm::dvec3 a = world_from_object * glm::dvec4(primitive.positions[t.x], 1),
                                 b = world_from_object * glm::dvec4(primitive.positions[t.y], 1),
                                 c = world_from_object * glm::dvec4(primitive.positions[t.z], 1),
                                 d(ray.direction), s = glm::dvec3(ray.origin) - a;
                const glm::dvec3 p = glm::cross(d, c - a), q = glm::cross(s, b - a),
                                 normal = glm::cross(b - a, c - a) * side;
                const double det = glm::dot(b - a, p);
                const bool grazes = std::abs(det) < 1e-2 * glm::length(normal);
                if (det == 0)
                    continue;
                const double u = glm::dot(s, p) / det, v = glm::dot(d, q) / det,
                             distance_m = glm::dot(c - a, q) / det;
                const double inside = std::min({u, v, 1 - u - v});
                if (distance_m < -distance_tolerance_m || distance_m > ray.far_m + distance_tolerance_m ||
                    inside < -edge_tolerance)
                    continue;
                if (inside < edge_tolerance || grazes || std::abs(distance_m) < distance_tolerance_m ||
                    std::abs(distance_m - ray.far_m) < distance_tolerance_m)
                    unsure_m = std::min(unsure_m, distance_m);
                else if (distance_m < best.distance_m)
                    best = {distance_m, normal / glm::length(normal), true};
            }
        }
    }
    best.sure = std::isinf(unsure_m) || unsure_m > best.distance_m + distance_tolerance_m;
    return best;
}

TEST(ClosestHit, AgreesWithASlowLoopOverTurnedScaledAndMirroredSoups) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
        std::mt19937 random(seed);
        std::vector<Thing> things;
        for (int n = 0; n < 6; ++n) {
            const Shape soup = triangle_soup(random, 40, 2);
            for (const bool mirrored : {false, true}) {
                things.push_back(thing_of(soup));
                things.back().world_from_shape = random_placement(random, 15, mirrored);
            }
        }
        const auto map = map_of(things);
        ASSERT_EQ(map->objects.size(), 12u);
        const auto scene = scene_of(map);
        int compared = 0, hits = 0;
        for (int n = 0; n < 4000; ++n) {
            const Ray ray{{between(random, -20, 20), between(random, -20, 20), between(random, -10, 10)},
                          random_direction(random),
                          n % 3 == 0 ? 8.0f : 1000.0f};
            const SlowHit slow = slow_closest(*map, ray);
            if (!slow.sure)
                continue;
            ++compared;
            const auto hit = scene->closest(ray);
            ASSERT_EQ(hit.has_value(), std::isfinite(slow.distance_m)) << "ray " << n;
            EXPECT_EQ(scene->occluded(ray), hit.has_value()) << "ray " << n;
            if (!hit)
                continue;
            ++hits;
            EXPECT_NEAR(hit->distance_m, slow.distance_m, distance_tolerance_m);
            EXPECT_LE(hit->distance_m, ray.far_m);
            EXPECT_EQ(hit->front, glm::dot(slow.normal, glm::dvec3(ray.direction)) < 0);
            EXPECT_LT(glm::dot(hit->normal, ray.direction), 0) << "the normal is not on the ray's side";
            EXPECT_NEAR(std::abs(glm::dot(glm::dvec3(hit->normal), slow.normal)), 1, 1e-5);
            // u and v lead back to the point.
            const map::Object& object = scene->object_of(*hit);
            const map::Primitive& primitive = map->meshes[object.mesh].primitives[hit->primitive];
            const glm::uvec3& t = primitive.triangles[hit->triangle];
            const glm::vec3 local = primitive.positions[t.x] * (1 - hit->u - hit->v) +
                                    primitive.positions[t.y] * hit->u + primitive.positions[t.z] * hit->v;
            EXPECT_LT(glm::distance(object.world_from_object * glm::vec4(local, 1),
                                    ray.origin + ray.direction * hit->distance_m),
                      3e-4f);
        }
        EXPECT_GT(compared, 3000);
        EXPECT_GT(hits, 500);
    }
}

TEST(ClosestHit, DoesNotDependOnTheRegionAsLongAsTheObjectIsWithinReach) {
    std::mt19937 random(9);
    std::vector<Thing> things;
    for (int n = 0; n < 12; ++n) {
        things.push_back(thing_of(triangle_soup(random, 30, 3)));
        things.back().world_from_shape = random_placement(random, n < 6 ? 20 : 200, n % 2 == 1);
    }
    const auto map = map_of(things);
    const auto whole = scene_of(map), near = scene_of(map, {glm::vec2(-5), glm::vec2(5)}, 60);
    ASSERT_LT(near->object_count(), whole->object_count());
    ASSERT_GT(near->object_count(), 0u);
    int hits = 0;
    for (int n = 0; n < 20000; ++n) {
        const Ray ray{{between(random, -5, 5), between(random, -5, 5), between(random, -9, 9)},
                      random_direction(random),
                      60};
        const auto a = whole->closest(ray), b = near->closest(ray);
        ASSERT_EQ(a.has_value(), b.has_value());
        ASSERT_EQ(whole->occluded(ray), near->occluded(ray));
        if (!a)
            continue;
        ++hits;
        EXPECT_EQ(std::tie(a->distance_m, a->u, a->v, a->primitive, a->triangle, a->front, a->normal),
                  std::tie(b->distance_m, b->u, b->v, b->primitive, b->triangle, b->front, b->normal));
        EXPECT_EQ(&whole->object_of(*a), &near->object_of(*b));
    }
    EXPECT_GT(hits, 100);
}

TEST(ClosestHit, StaticBackAbsorbsAndLeavesReflectOnBothSides) {
    for (const bool mirrored : {false, true}) {
        const glm::dmat4 place = glm::scale(glm::dmat4(1), glm::dvec3(mirrored ? -1 : 1, 1, 1));
        for (const auto& [role, double_sided, absorbs] :
             {std::tuple{"static", false, true}, {"static", true, false}, {"vegetation", false, false}}) {
            Thing square = thing_of(level_square(1), {0.5, 0.25, 0.125}, role);
            square.world_from_shape = place;
            square.material.double_sided = double_sided;
            const auto scene = scene_of(std::vector<Thing>{square});
            const auto above = scene->closest({{0.1f, 0.2f, 5}, {0, 0, -1}, 10}),
                       below = scene->closest({{0.1f, 0.2f, -5}, {0, 0, 1}, 10});
            ASSERT_TRUE(above && below);
            EXPECT_TRUE(above->front && !below->front)
                << "glTF turns the winding of a mirrored node, so that its front stays up";
            EXPECT_EQ(above->normal, glm::vec3(0, 0, 1));
            EXPECT_EQ(below->normal, glm::vec3(0, 0, -1));
            EXPECT_FALSE(scene->surface(*above, 0).absorbs);
            EXPECT_EQ(scene->surface(*above, 0).albedo, glm::vec3(0.5, 0.25, 0.125));
            EXPECT_EQ(scene->surface(*below, 0).absorbs, absorbs) << role;
            EXPECT_EQ(scene->surface(*below, 0).albedo, absorbs ? glm::vec3(0) : glm::vec3(0.5, 0.25, 0.125))
                << role;
        }
    }
}

TEST(ClosestHit, FarIsInclusiveAndNothingBeyondCounts) {
    const auto scene = scene_of(std::vector<Thing>{thing_of(level_square(10))});
    EXPECT_TRUE(scene->closest({{0.5f, 0.25f, 4}, {0, 0, -1}, 4}));
    EXPECT_TRUE(scene->occluded({{0.5f, 0.25f, 4}, {0, 0, -1}, 4}));
    EXPECT_FALSE(scene->closest({{0.5f, 0.25f, 4}, {0, 0, -1}, 3.999f}));
    EXPECT_FALSE(scene->occluded({{0.5f, 0.25f, 4}, {0, 0, -1}, 3.999f}));
    EXPECT_FALSE(scene->closest({{0.5f, 0.25f, 4}, {0, 0, 1}, 1000}));
}

TEST(ClosestHit, EmptySceneIsSky) {
    const auto scene = scene_of(map_of(std::vector<Thing>{thing_of(level_square(10))}),
                                {glm::vec2(500), glm::vec2(600)}, 10);
    EXPECT_EQ(scene->object_count(), 0u);
    EXPECT_FALSE(scene->closest({{0, 0, 4}, {0, 0, -1}, 1000}));
    EXPECT_FALSE(scene->occluded({{0, 0, 4}, {0, 0, -1}, 1000}));
    std::vector<placement::ColumnHit> hits(3);
    scene->column({0, 0}, hits);
    EXPECT_TRUE(hits.empty());
}

// A ray along an axis, or in a plane of two, is asked for beside its line: there it may start beyond the
// surface that it leaves.
TEST(RayAlongAnAxis, LeavesTheSurfaceThatItStartsOn) {
    std::mt19937 random(31);
    int asked = 0;
    for (int n = 0; n < 200; ++n) {
        Thing thing = thing_of(level_square(4));
        thing.world_from_shape = random_placement(random, n < 100 ? 20 : 4000, n % 2 == 1);
        const auto scene = scene_of(std::vector{thing});
        const glm::vec3 middle(scene->bounds().low * 0.5f + scene->bounds().high * 0.5f);
        for (int k = 0; k < 20; ++k) {
            const glm::vec3 way = random_direction(random);
            const Ray there{middle - way * 30.0f, way, 100};
            const auto hit = scene->closest(there);
            const float facing = hit ? -glm::dot(hit->normal, way) : 0;
            if (facing < 0.05f)
                continue;
            // As paths go on from a surface.
            const float back_m = trace::rounding_m(there, hit->distance_m) / facing;
            glm::vec3 onward = random_direction(random);
            onward[k % 3] = 0;
            if (k % 2 == 0)
                onward[(k + 1) % 3] = 0;
            onward = glm::normalize(onward);
            if (glm::dot(onward, hit->normal) < 0)
                onward = -onward;
            if (glm::dot(onward, hit->normal) < 0.02f)
                continue;
            const Ray ray{there.origin + way * (hit->distance_m - back_m), onward, 1000};
            ++asked;
            EXPECT_FALSE(scene->occluded(ray)) << n << ", " << k;
            EXPECT_FALSE(scene->closest(ray)) << n << ", " << k;
            EXPECT_EQ(scene->crossings(ray), 0) << n << ", " << k;
            EXPECT_EQ(scene->share_seen(ray, false), glm::vec3(1)) << n << ", " << k;
        }
    }
    EXPECT_GT(asked, 1500);
}

}  // namespace
}  // namespace drtv::test
