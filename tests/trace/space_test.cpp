// What stands where: closed parts of meshes, what is around a point, sight and walls.
#include "bakerd/trace/closed_parts.h"
#include "tests/trace/scenes.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace drtv::test {
namespace {

Shape turned(Shape shape) {
    for (std::size_t n = 0; n < shape.indices.size(); n += 3)
        std::swap(shape.indices[n], shape.indices[n + 1]);
    return shape;
}

Shape joined(const std::vector<Shape>& shapes) {
    Shape all;
    for (const Shape& shape : shapes) {
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        all.positions.insert(all.positions.end(), shape.positions.begin(), shape.positions.end());
        for (const std::uint32_t index : shape.indices)
            all.indices.push_back(first + index);
    }
    return all;
}

trace::ClosedParts parts_of(const Shape& shape) {
    const auto map = map_of(std::vector<Thing>{thing_of(shape)});
    return trace::ClosedParts(*map, map->meshes.at(0));
}

TEST(ClosedParts, AreThoseWhoseEdgesAreAllPaired) {
    EXPECT_FALSE(parts_of(box({0, 0, 0}, {1, 2, 3})).empty());
    EXPECT_TRUE(parts_of(level_square(4)).empty());
    Shape open = box({0, 0, 0}, {1, 2, 3});
    open.indices.resize(open.indices.size() - 3);
    EXPECT_TRUE(parts_of(open).empty());
    Shape one_turned = box({0, 0, 0}, {1, 2, 3});
    std::swap(one_turned.indices[0], one_turned.indices[1]);
    EXPECT_TRUE(parts_of(one_turned).empty());
    EXPECT_TRUE(parts_of(joined({level_square(4), turned(level_square(4))})).empty()) << "it bounds nothing";
}

TEST(ClosedParts, OfOneMeshAreToldApart) {
    const trace::ClosedParts parts =
        parts_of(joined({box({0, 0, 0}, {1, 1, 1}), level_square(9), turned(box({5, 0, 0}, {7, 2, 2}))}));
    const std::uint32_t first = parts.part_of(0, 0), last = parts.part_of(0, 14);
    EXPECT_EQ(parts.part_of(0, 12), trace::ClosedParts::none);
    EXPECT_NE(first, last);
    // Worlds and glTF turn the axes, and keep inside and outside.
    EXPECT_TRUE(parts.part(first).outward);
    EXPECT_FALSE(parts.part(last).outward);
    EXPECT_EQ(parts.part(last).bounds.high.x - parts.part(last).bounds.low.x, 2);
}

// In a box turned, stretched and mirrored, of either role, as an instance and as part of the world.
TEST(Around, AgreesWithTheFormulaOfATurnedBox) {
    std::mt19937 random(9);
    for (const bool mirrored : {false, true}) {
        for (const float half : {3.0f, 70.0f}) {
            const glm::dmat4 place = random_placement(random, 20, mirrored);
            Thing thing = thing_of(box(glm::vec3(-half), glm::vec3(half)), glm::vec3(1),
                                   mirrored ? "vegetation" : "static");
            thing.world_from_shape = place;
            const auto scene = scene_of(std::vector<Thing>{thing});
            const glm::dmat4 back = glm::inverse(place);
            int wrong = 0, inside = 0;
            for (int n = 0; n < 3000; ++n) {
                const glm::dvec3 at = glm::dvec3(place * glm::dvec4(between(random, -2 * half, 2 * half),
                                                                    between(random, -2 * half, 2 * half),
                                                                    between(random, -2 * half, 2 * half), 1));
                const glm::vec3 point(at);
                const glm::dvec3 own = glm::abs(glm::dvec3(back * glm::dvec4(glm::dvec3(point), 1)));
                const double most = std::max({own.x, own.y, own.z});
                if (std::abs(most - half) < 1e-3 * half)
                    continue;
                inside += most < half ? 1 : 0;
                wrong += scene->closed_around(point).has_value() != (most < half) ? 1 : 0;
            }
            EXPECT_EQ(wrong, 0);
            EXPECT_GT(inside, 100);
        }
    }
}

struct Nested {
    const char* name;
    std::vector<Shape> objects;  // each an object of its own
    glm::vec3 point;
    bool inside;
};

TEST(Around, NestedAndOverlappingPartsCountAsTheyBound) {
    const Shape outer = box({-9, -9, -9}, {9, 9, 9}), middle = box({-6, -6, -6}, {6, 6, 6}),
                inner = box({-3, -3, -3}, {3, 3, 3});
    const Nested cases[] = {
        {"a solid", {outer}, {0, 0, 0}, true},
        {"a room without walls' thickness", {turned(outer)}, {0, 0, 0}, false},
        {"a room in a house, of one mesh", {joined({outer, turned(middle)})}, {0, 0, 0}, false},
        {"its walls", {joined({outer, turned(middle)})}, {7.5f, 0, 0}, true},
        {"a room in a house, of two", {outer, turned(middle)}, {0, 0, 0}, false},
        {"a cupboard in a room in a house", {outer, turned(middle), inner}, {0, 0, 0}, true},
        {"beside the cupboard", {outer, turned(middle), inner}, {5, 0, 0}, false},
        {"a pillar in a room", {turned(outer), box({-2, -2, -10}, {2, 2, 10})}, {0, 0, 0}, true},
        {"beside the pillar", {turned(outer), box({-2, -2, -10}, {2, 2, 10})}, {5, 0, 0}, false},
        {"rocks that poke into each other", {outer, box({0, -9, -9}, {20, 9, 9})}, {5, 0, 0}, true},
        {"the same twice", {outer, outer}, {0, 0, 0}, true},
        {"above all", {outer, middle}, {0, 0, 12}, false},
    };
    for (const auto& [name, objects, point, inside] : cases) {
        std::vector<Thing> things;
        for (const Shape& shape : objects)
            things.push_back(thing_of(shape));
        for (int order = 0; order < 2; ++order) {
            EXPECT_EQ(scene_of(things)->closed_around(point).has_value(), inside) << name;
            std::ranges::reverse(things);
        }
    }
}

// On edges and corners of the lattice that a kit stands on, lines meet edges exactly.
TEST(Around, AKitOfBoxesIsSolidAtEveryPointInside) {
    std::vector<Thing> things;
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) {
            const glm::vec3 corner(4 * x, 4 * y, 0);
            things.push_back(thing_of(box(corner, corner + glm::vec3(4, 4, 8)),
                                      glm::vec3(0.05f * static_cast<float>(x + 4 * y))));
        }
    }
    const auto scene = scene_of(things);
    int wrong = 0;
    for (float z = 0.5f; z < 8; z += 1) {
        for (float y = 0.5f; y < 16; y += 0.5f) {
            for (float x = 0.5f; x < 16; x += 0.5f)
                wrong += scene->closed_around({x, y, z}) ? 0 : 1;
        }
    }
    EXPECT_EQ(wrong, 0);
}

TEST(Sight, LeavesGlassAndFencesNeverSeparate) {
    const glm::vec3 up(0, 0, 1);
    const trace::Ray ray{{1.5f, 0.5f, -5}, up, 10};
    Thing plate = thing_of(level_square(2));
    EXPECT_TRUE(scene_of(std::vector<Thing>{plate})->separated(ray));
    plate.role = "vegetation";
    EXPECT_FALSE(scene_of(std::vector<Thing>{plate})->separated(ray));
    EXPECT_TRUE(scene_of(std::vector<Thing>{plate})->occluded(ray));
    Thing fence = thing_of(level_square(2));
    fence.material.texture = 0;
    fence.material.mask_cutoff = 0.5;
    EXPECT_TRUE(scene_of(std::vector<Thing>{fence})->occluded(ray));
    EXPECT_FALSE(scene_of(std::vector<Thing>{fence})->separated(ray));
}

TEST(Sides, TellFrontsBacksAndSheets) {
    std::vector<Thing> things = {thing_of(level_square(50, 0)), thing_of(box({-3, -3, 4}, {3, 3, 6})),
                                 thing_of(box({-3, -3, 8}, {3, 3, 9}), glm::vec3(1), "vegetation"),
                                 thing_of(level_square(9, 12), glm::vec3(1), "vegetation"),
                                 thing_of(level_square(9, 15))};
    things[4].material.double_sided = true;
    auto sides = scene_of(things)->sides_met({{1.25f, 0.5f, 20}, {0, 0, -1}, 30});
    std::ranges::sort(sides, {}, &placement::Side::distance_m);
    ASSERT_EQ(sides.size(), 6u) << "leaves are left out, a closed trunk is not";
    const placement::Side expected[] = {{5, true, true},   {11, true, false},  {12, false, false},
                                        {14, true, false}, {16, false, false}, {20, true, false}};
    for (std::size_t n = 0; n < 6; ++n) {
        EXPECT_EQ(sides[n].distance_m, expected[n].distance_m);
        EXPECT_EQ(sides[n].front, expected[n].front) << n;
        EXPECT_EQ(sides[n].sheet, expected[n].sheet) << n;
    }
}

TEST(Walls, AreStaticOrBoundVolumes) {
    const std::vector<Thing> things = {thing_of(level_square(50, 0)),
                                       thing_of(box({10, 10, 4}, {13, 13, 6}), glm::vec3(1), "vegetation"),
                                       thing_of(level_square(2, 9), glm::vec3(1), "vegetation")};
    const auto scene = scene_of(things);
    EXPECT_TRUE(scene->wall_within({0, 0, 0.01f}, 0.02f));
    EXPECT_FALSE(scene->wall_within({0, 0, 0.03f}, 0.02f));
    EXPECT_TRUE(scene->wall_within({10.01f, 11, 5}, 0.02f));
    EXPECT_FALSE(scene->wall_within({0, 0, 9}, 0.02f)) << "leaves";
    EXPECT_EQ(scene->distance_to_surface({0, 0, 9.01f}, 1), 9.01f - 9.0f);
}

// Two rooms, one on the other: of ceiling and floor, whose planes are off by less than rounding either way, a
// grazing ray from below meets the ceiling's front, whatever the order of the objects.
TEST(Fronts, AreMetBeforeBacksOfTheirPlaneDownToAQuarterOfADegree) {
    std::mt19937 random(77);
    int backs = 0, rays = 0;
    for (int n = 0; n < 400; ++n) {
        const float z = between(random, 3, 60), rounding = z * 0x1p-20f;
        const float gap = between(random, -0.9f, 0.9f) * rounding;
        Thing ceiling = thing_of(turned(level_square(90, z)), glm::vec3(between(random, 0.1f, 0.9f)));
        Thing floor = thing_of(level_square(90, z + gap), glm::vec3(between(random, 0.1f, 0.9f)));
        const auto scene = scene_of(std::vector<Thing>{ceiling, floor});
        for (const float cosine : {0.004f, 0.006f, 0.02f, 0.06f, 0.5f, 1.0f}) {
            const float turn = between(random, 0, 6.28f), flat = std::sqrt(1 - cosine * cosine);
            const glm::vec3 direction =
                glm::normalize(glm::vec3(flat * std::cos(turn), flat * std::sin(turn), cosine));
            const auto hit = scene->closest(
                {{between(random, -3, 3), between(random, -3, 3), z - 80 * cosine * 0.9f}, direction, 500});
            ASSERT_TRUE(hit);
            ++rays;
            backs += hit->front ? 0 : 1;
        }
    }
    EXPECT_EQ(backs, 0) << "of " << rays;
}

TEST(Crossings, OfAFrontAndABackInOnePlaneAreOne) {
    const std::vector<Thing> things = {thing_of(level_square(5)), thing_of(turned(level_square(5)))};
    EXPECT_EQ(scene_of(things)->crossings({{1.25f, 0.5f, 3}, {0, 0, -1}, 9}), 1u);
    EXPECT_EQ(scene_of(things)->crossings({{1.25f, 0.5f, -3}, {0, 0, 1}, 9}), 1u);
    std::vector<Thing> apart = things;
    apart[1].world_from_shape = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -0.01));
    EXPECT_EQ(scene_of(apart)->crossings({{1.25f, 0.5f, 3}, {0, 0, -1}, 9}), 2u);
}

}  // namespace
}  // namespace drtv::test
