// Rays exactly onto the border between instances, where kits are put together: Embree finds instances without
// its robust test (trace/instance_margin.h). cpu.InstanceBorders runs these under QEMU too, where every
// machine could see the gaps.
#include "bakerd/trace/instance_margin.h"
#include "tests/trace/scenes.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <string>

namespace drtv::test {
namespace {

constexpr int tiles = 4;
constexpr float tile_m = 10;

// How a tile is modelled, and what makes it [0, 1] x [0, 1] x {0}; every second tile may be turned half
// round.
struct Kit {
    std::string name;
    Shape tile;
    glm::dmat4 placed{1};  // of the tile's own space into [0, 1] x [0, 1]
    double east_m = 0, north_m = 0;
    bool half_turned = false;
};

Shape level_tile(float size) {
    return quad({0, 0, 0}, {size, 0, 0}, {size, size, 0}, {0, size, 0});
}

// With inner nodes in its BVH.
Shape fine_tile() {
    constexpr std::uint32_t cells = 16;
    Shape shape;
    for (std::uint32_t y = 0; y <= cells; ++y) {
        for (std::uint32_t x = 0; x <= cells; ++x)
            shape.positions.emplace_back(static_cast<float>(x) / cells, static_cast<float>(y) / cells, 0);
    }
    for (std::uint32_t y = 0; y < cells; ++y) {
        for (std::uint32_t x = 0; x < cells; ++x) {
            const std::uint32_t k = y * (cells + 1) + x;
            shape.indices.insert(shape.indices.end(),
                                 {k, k + 1, k + cells + 2, k, k + cells + 2, k + cells + 1});
        }
    }
    return shape;
}

std::vector<Kit> kits() {
    const glm::dmat4 one(1);
    // A quarter of a turn without the rounding of a sine.
    const glm::dmat4 turned(glm::dvec4(0, 1, 0, 0), glm::dvec4(-1, 0, 0, 0), glm::dvec4(0, 0, 1, 0),
                            glm::dvec4(1, 0, 0, 1));
    return {
        {"as it stands", level_tile(1), one},
        {"in centimetres", level_tile(128), glm::scale(one, glm::dvec3(1 / 128.0))},
        {"tiny", level_tile(1 / 4096.0f), glm::scale(one, glm::dvec3(4096))},
        {"turned", level_tile(1), turned},
        {"mirrored", level_tile(1),
         glm::translate(one, glm::dvec3(1, 0, 0)) * glm::scale(one, glm::dvec3(-1, 1, 1))},
        {"thin", level_tile(1), glm::scale(one, glm::dvec3(1, 1, 1 / 256.0))},
        {"a box without height", box({0, 0, -1}, {1, 1, 1}), glm::scale(one, glm::dvec3(1, 1, 0))},
        {"sheared", level_tile(1),
         glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(4, 4, 1, 0),
                    glm::dvec4(0, 0, 0, 1))},
        {"sheared flat", level_tile(1),
         glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(64, 64, 1, 0),
                    glm::dvec4(0, 0, 0, 1))},
        {"far", level_tile(1), one, 6400, -7040},
        {"far and turned", level_tile(128), turned * glm::scale(one, glm::dvec3(1 / 128.0)), -7680, 5120},
        {"in one quadrant", level_tile(1), one, 40, 60},
        {"in another", level_tile(1), one, -40, 20},
        {"of many triangles, in one quadrant", fine_tile(), one, 20, -60},
        {"of many triangles", fine_tile(), one},
        {"of many triangles, every second turned", fine_tile(), one, 0, 0, true},
        {"of many triangles, every second turned, far", fine_tile(), one, -5120, 6400, true},
    };
}

// 4 x 4 tiles of 10 m around the kit's place; standing up where asked, as walls across the x axis.
std::shared_ptr<const trace::Scene> laid(const Kit& kit, bool standing) {
    const glm::dmat4 half_turn(glm::dvec4(-1, 0, 0, 0), glm::dvec4(0, -1, 0, 0), glm::dvec4(0, 0, 1, 0),
                               glm::dvec4(1, 1, 0, 1));
    const glm::dmat4 up(glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, 1, 0), glm::dvec4(1, 0, 0, 0),
                        glm::dvec4(0, 0, 0, 1));
    std::vector<Thing> things;
    for (int j = 0; j < tiles; ++j) {
        for (int i = 0; i < tiles; ++i) {
            things.push_back(thing_of(kit.tile));
            const glm::dmat4 in_plane =
                glm::translate(glm::dmat4(1), glm::dvec3(tile_m * static_cast<float>(i - 2),
                                                         tile_m * static_cast<float>(j - 2), 0)) *
                glm::scale(glm::dmat4(1), glm::dvec3(tile_m)) *
                (kit.half_turned && (i + j) % 2 == 1 ? half_turn : glm::dmat4(1)) * kit.placed;
            things.back().world_from_shape =
                glm::translate(glm::dmat4(1), glm::dvec3(kit.east_m, kit.north_m, 3)) *
                (standing ? up : glm::dmat4(1)) * in_plane;
        }
    }
    return scene_of(things);
}

// How far from the middle the rays go: to the outer rim, but far from the origin, where a scaled tile is
// rounded by millimetres.
int rim(const Kit& kit) {
    return std::abs(kit.east_m) < 1000 ? 20 : 15;
}

constexpr int step = 5;  // metres: borders, and the middles of tiles

// Rays onto the laid tiles, straight or a billionth off; at the outer rim, where such a ray may leave them,
// straight alone.
std::vector<trace::Ray> rays_onto(const Kit& kit, bool standing) {
    std::vector<trace::Ray> rays;
    for (int y = -rim(kit); y <= rim(kit); y += step) {
        for (int x = -rim(kit); x <= rim(kit); x += step) {
            for (const float aside : {0.0f, 1e-9f, -1e-9f}) {
                if (aside != 0 && std::max(std::abs(x), std::abs(y)) == 20)
                    continue;
                const glm::vec3 at(static_cast<float>(kit.east_m), static_cast<float>(kit.north_m), 3);
                const auto a = static_cast<float>(x), b = static_cast<float>(y);
                if (standing)
                    rays.push_back({at + glm::vec3(60, a, b), {-1, aside, 0}, 200});
                else
                    rays.push_back({at + glm::vec3(a, b, 90), {aside, 0, -1}, 200});
            }
        }
    }
    return rays;
}

TEST(InstanceBorders, AreMetByEveryKindOfRay) {
    const trace::FloatMode float_mode;
    for (const Kit& kit : kits()) {
        for (const bool standing : {false, true}) {
            SCOPED_TRACE(kit.name + (standing ? ", standing" : ", lying"));
            const auto scene = laid(kit, standing);
            const std::vector<trace::Ray> rays = rays_onto(kit, standing);
            int missed = 0, lit = 0, uncrossed = 0, wrong = 0;
            for (const trace::Ray& ray : rays) {
                const auto hit = scene->closest(ray);
                missed += hit ? 0 : 1;
                wrong += hit && hit->distance_m != (standing ? 60 : 90) ? 1 : 0;
                lit += scene->occluded(ray) ? 0 : 1;
                uncrossed += scene->crossings(ray) > 0 ? 0 : 1;
            }
            std::vector<bool> hidden;
            scene->occluded(rays, hidden);
            EXPECT_EQ(missed, 0) << "of " << rays.size();
            EXPECT_EQ(wrong, 0);
            EXPECT_EQ(lit, 0);
            EXPECT_EQ(uncrossed, 0);
            EXPECT_EQ(std::ranges::count(hidden, false), 0) << "in a stream";
        }
    }
}

TEST(InstanceBorders, AreMetByColumnsAndPointQueries) {
    const trace::FloatMode float_mode;
    for (const Kit& kit : kits()) {
        SCOPED_TRACE(kit.name);
        const auto scene = laid(kit, false);
        int empty = 0, far = 0;
        std::vector<placement::ColumnHit> hits;
        for (int y = -rim(kit); y <= rim(kit); y += step) {
            for (int x = -rim(kit); x <= rim(kit); x += step) {
                const glm::vec2 at(static_cast<float>(kit.east_m) + static_cast<float>(x),
                                   static_cast<float>(kit.north_m) + static_cast<float>(y));
                scene->column(at, hits);
                empty += hits.empty() || hits.front().z_m != 3 ? 1 : 0;
                far += scene->distance_to_surface(glm::vec3(at, 3.5f), 10) == 0.5f ? 0 : 1;
            }
        }
        EXPECT_EQ(empty, 0);
        EXPECT_EQ(far, 0);
    }
}

// Against the exact answer in double: a wall or floor, far out, stretched from a cube, with something close
// behind.
TEST(InstanceBorders, StretchedThingsHideWhatIsBehindThem) {
    const trace::FloatMode float_mode;
    std::mt19937 random(23);
    for (const float away_m : {0.0f, 1000.0f, 4000.0f, 7900.0f}) {
        for (const glm::vec3 scale :
             {glm::vec3(20, 20, 0.05f), glm::vec3(0.05f, 20, 20), glm::vec3(4, 4, 4)}) {
            const glm::dvec3 place(double{away_m}, double{-away_m}, 5);
            std::vector<Thing> things = {thing_of(box({-1, -1, -1}, {1, 1, 1}), glm::vec3(0.2f)),
                                         thing_of(box({-1, -1, -1}, {1, 1, 1}), glm::vec3(0.9f))};
            things[0].world_from_shape = glm::scale(glm::translate(glm::dmat4(1), place), glm::dvec3(scale));
            things[1].world_from_shape =
                glm::scale(glm::translate(glm::dmat4(1), place), glm::dvec3(scale) * 0.8);
            const auto scene = scene_of(things);
            int behind = 0, through = 0;
            for (int n = 0; n < 4000; ++n) {
                const glm::vec3 inside = glm::vec3(place) + scale * glm::vec3(between(random, -0.7f, 0.7f),
                                                                              between(random, -0.7f, 0.7f),
                                                                              between(random, -0.7f, 0.7f));
                const glm::vec3 from = inside + random_direction(random) * 60.0f;
                const trace::Ray ray{from, glm::normalize(inside - from), glm::distance(inside, from)};
                const auto hit = scene->closest(ray);
                behind += hit && scene->surface(*hit, 0).albedo.x < 0.5f ? 0 : 1;
                through += scene->occluded(ray) ? 0 : 1;
            }
            EXPECT_EQ(behind, 0) << away_m << " m out, scaled by " << scale.x << ", " << scale.y << ", "
                                 << scale.z;
            EXPECT_EQ(through, 0) << away_m << " m out, scaled by " << scale.x << ", " << scale.y << ", "
                                  << scale.z;
        }
    }
}

TEST(InstanceShape, GrowsTheBoxByTheMargin) {
    std::mt19937 random(3);
    constexpr float margin_m = 0.25f;
    for (int n = 0; n < 2000; ++n) {
        glm::dmat4 m = random_placement(random, 100, n % 2 == 0);
        m = m * glm::scale(glm::dmat4(1),
                           glm::dvec3(std::exp(between(random, -4, 4)), std::exp(between(random, -4, 4)),
                                      std::exp(between(random, -4, 4))));
        if (n % 3 == 0)
            m[2] += m[0] * double{between(random, -0.5f, 0.5f)} + m[1] * double{between(random, -0.5f, 0.5f)};
        const glm::mat4x3 world_from_object(m);
        const auto shape = trace::instance_shape(world_from_object, margin_m);
        if (!shape)
            continue;
        const glm::vec3 grown = glm::abs(world_from_object[0]) * shape->margin.x +
                                glm::abs(world_from_object[1]) * shape->margin.y +
                                glm::abs(world_from_object[2]) * shape->margin.z;
        for (glm::length_t k = 0; k < 3; ++k)
            EXPECT_GE(grown[k], margin_m * 0.9999f);
        float shortest = 1e30f, longest = 0;
        for (int direction = 0; direction < 200; ++direction) {
            const float length = glm::length(glm::mat3(world_from_object) * random_direction(random));
            shortest = std::min(shortest, length);
            longest = std::max(longest, length);
        }
        EXPECT_LE(longest, shortest * shape->spread * 1.0001f);
    }
}

TEST(InstanceShape, IsNoneWhereTheInverseWouldBeRounding) {
    const glm::mat4x3 flat(glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0), glm::vec3(0)),
        sheared(glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(64, 64, 1), glm::vec3(0));
    const glm::mat4x3 needle(glm::vec3(1, 0, 0), glm::vec3(0, 1e-6f, 0), glm::vec3(0, 0, 1), glm::vec3(0)),
        one(1);
    EXPECT_FALSE(trace::instance_shape(flat, 1));
    EXPECT_FALSE(trace::instance_shape(sheared, 1));
    EXPECT_FALSE(trace::instance_shape(needle, 1));
    EXPECT_EQ(trace::instance_shape(one, 1)->margin, glm::vec3(1));
    EXPECT_EQ(trace::instance_shape(one, 1)->spread, 1);
}

}  // namespace
}  // namespace drtv::test
