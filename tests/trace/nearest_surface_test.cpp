// The distance to the nearest surface against points strewn over all triangles.
#include "tests/trace/scenes.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <limits>

namespace drtv::test {
namespace {

constexpr int grid = 40;

struct Bracket {
    double least = std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
};

// No surface is nearer than `least`, and one is as near as `most`.
Bracket strewn(const map::Map& map, const glm::dvec3& point) {
    Bracket nearest;
    for (const map::Object& object : map.objects) {
        for (const map::Primitive& primitive : map.meshes[object.mesh].primitives) {
            for (const glm::uvec3& t : primitive.triangles) {
                const auto corner = [&](std::uint32_t n) {
                    return glm::dmat4x3(object.world_from_object) * glm::dvec4(primitive.positions[n], 1);
                };
                const glm::dvec3 a = corner(t.x), b = corner(t.y), c = corner(t.z);
                const double between_points =
                    std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)}) / grid;
                for (int u = 0; u <= grid; ++u) {
                    for (int v = 0; u + v <= grid; ++v) {
                        const double distance = glm::length(a + (b - a) * (double(u) / grid) +
                                                            (c - a) * (double(v) / grid) - point);
                        nearest.most = std::min(nearest.most, distance);
                        nearest.least = std::min(nearest.least, distance - between_points);
                    }
                }
            }
        }
    }
    return nearest;
}

TEST(NearestSurface, AgreesWithPointsStrewnOverTurnedScaledMirroredAndLargeThings) {
    std::mt19937 random(7);
    std::vector<Thing> things;
    for (int n = 0; n < 6; ++n) {
        const Shape soup = triangle_soup(random, 12, 2);
        for (const bool mirrored : {false, true}) {
            const glm::dmat4 place = glm::translate(
                glm::dmat4(1),
                glm::dvec3(between(random, -8, 8), between(random, -8, 8), between(random, -3, 3)));
            const glm::dmat4 turned =
                glm::rotate(place, double{between(random, 0, 6)}, glm::dvec3(random_direction(random)));
            things.push_back({soup, glm::scale(turned, glm::dvec3(mirrored ? -1.3 : 1, 0.5, 2))});
        }
    }
    things.push_back({level_square(80, -12)});  // large: not an instance
    const auto map = map_of(things);
    const auto scene = scene_of(map);
    for (int n = 0; n < 60; ++n) {
        const glm::vec3 point(between(random, -12, 12), between(random, -12, 12), between(random, -14, 6));
        const Bracket nearest = strewn(*map, point);
        const float distance_m = scene->distance_to_surface(point, 500);
        EXPECT_LE(distance_m, nearest.most + 1e-4) << n;
        EXPECT_GE(distance_m, nearest.least - 1e-4) << n;
        // Not farther than asked.
        EXPECT_EQ(scene->distance_to_surface(point, distance_m / 2), distance_m / 2);
    }
}

TEST(NearestSurface, FacesEdgesAndCornersOfASquare) {
    const auto scene = scene_of(std::vector<Thing>{{level_square(2)}});
    EXPECT_FLOAT_EQ(scene->distance_to_surface({1, 0.5f, 3}, 100), 3);
    EXPECT_FLOAT_EQ(scene->distance_to_surface({6, 0, 3}, 100), 5);
    EXPECT_FLOAT_EQ(scene->distance_to_surface({-4, -4, 1}, 100), 3);
    EXPECT_EQ(scene->distance_to_surface({0, 0, 0}, 100), 0);
}

}  // namespace
}  // namespace drtv::test
