// All crossings of a vertical line.
#include "tests/trace/scenes.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace drtv::test {
namespace {

using placement::ColumnHit;

std::vector<ColumnHit> column(const trace::Scene& scene, glm::vec2 at) {
    std::vector<ColumnHit> hits(7);
    scene.column(at, hits);
    return hits;
}

TEST(Column, HeightOnASlopeIsExact) {
    // Heights are sums of halves and quarters: floats hold them.
    const auto height = [](float x, float y) { return 0.5f * x - 0.25f * y + 7; };
    const auto scene =
        scene_of(std::vector<Thing>{thing_of(quad({-64, -64, height(-64, -64)}, {64, -64, height(64, -64)},
                                                  {64, 64, height(64, 64)}, {-64, 64, height(-64, 64)}))});
    for (float y = -62; y < 64; y += 4) {
        for (float x = -62; x < 64; x += 4) {
            const std::vector<ColumnHit> hits = column(*scene, {x, y});
            ASSERT_TRUE(hits.size() == 1 || (hits.size() == 2 && x == y))
                << "two only on the shared diagonal";
            for (const ColumnHit& hit : hits) {
                EXPECT_EQ(hit.z_m, height(x, y));
                EXPECT_TRUE(hit.up_facing && !hit.down_facing);
            }
        }
    }
}

TEST(Column, StandsFromTheTopDownWithItsSides) {
    for (const bool mirrored : {false, true}) {
        std::vector<Thing> things = {thing_of(level_square(50)), thing_of(box({-3, -3, 4}, {3, 3, 6})),
                                     thing_of(level_square(9, 20)),
                                     thing_of(box({-9, -9, 8}, {9, 9, 9}), glm::vec3(1), "vegetation")};
        things[2].material.double_sided = true;
        if (mirrored) {
            for (Thing& thing : things)
                thing.world_from_shape = glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1));
        }
        const std::vector<ColumnHit> hits = column(*scene_of(things), {1.25f, 0.5f});
        ASSERT_EQ(hits.size(), 4u);
        const ColumnHit expected[] = {{20, true, true}, {6, true, false}, {4, false, true}, {0, true, false}};
        for (std::size_t n = 0; n < 4; ++n) {
            EXPECT_EQ(hits[n].z_m, expected[n].z_m);
            EXPECT_EQ(hits[n].up_facing, expected[n].up_facing) << n;
            EXPECT_EQ(hits[n].down_facing, expected[n].down_facing) << n;
            EXPECT_EQ(hits[n].body, n == 1 || n == 2) << n;
        }
    }
}

TEST(Column, DoesNotDependOnFarObjectsOrTheRegion) {
    std::mt19937 random(17);
    std::vector<Thing> things;
    for (int n = 0; n < 8; ++n) {
        things.push_back(thing_of(triangle_soup(random, 60, 3)));
        things.back().world_from_shape = random_placement(random, 10, n % 2 == 0);
    }
    const auto alone = scene_of(things);
    std::vector<Thing> more = things;
    for (int n = 0; n < 9; ++n) {
        more.push_back(thing_of(triangle_soup(random, 9, 3)));
        more.back().world_from_shape = glm::translate(glm::dmat4(1), glm::dvec3(900 + n * 30, 40, 5000));
    }
    const auto map = map_of(more);
    const auto crowded = scene_of(map), near = scene_of(map, {glm::vec2(-30), glm::vec2(30)}, 10);
    EXPECT_LT(near->object_count(), crowded->object_count());
    std::size_t crossings = 0;
    for (float y = -20; y < 20; y += 0.5f) {
        for (float x = -20; x < 20; x += 0.5f) {
            const std::vector<ColumnHit> a = column(*alone, {x, y}), b = column(*crowded, {x, y}),
                                         c = column(*near, {x, y});
            ASSERT_EQ(a.size(), b.size());
            ASSERT_EQ(a.size(), c.size());
            crossings += a.size();
            for (std::size_t n = 0; n < a.size(); ++n) {
                EXPECT_EQ(a[n].z_m, b[n].z_m);
                EXPECT_EQ(a[n].z_m, c[n].z_m);
                EXPECT_EQ(std::tie(a[n].up_facing, a[n].down_facing),
                          std::tie(b[n].up_facing, b[n].down_facing));
            }
        }
    }
    EXPECT_GT(crossings, 1000u);
}

TEST(Column, TerrainIsMetAtEveryVertexAndEdge) {
    // Vertices where the columns of the lattice stand, which is what exporters of terrain give.
    std::mt19937 random(31);
    for (const double turn : {0.0, 1.5707963267948966, 3.141592653589793}) {
        constexpr std::uint32_t side = 129;
        Shape terrain;
        for (std::uint32_t y = 0; y < side; ++y) {
            for (std::uint32_t x = 0; x < side; ++x)
                terrain.positions.emplace_back(static_cast<float>(x) - 64, static_cast<float>(y) - 64,
                                               between(random, -8, 8));
        }
        for (std::uint32_t y = 0; y + 1 < side; ++y) {
            for (std::uint32_t x = 0; x + 1 < side; ++x) {
                const std::uint32_t k = y * side + x;
                terrain.indices.insert(terrain.indices.end(),
                                       {k, k + 1, k + side + 1, k, k + side + 1, k + side});
            }
        }
        Thing thing = thing_of(terrain);
        thing.world_from_shape =
            glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(640, -1280, 30)), turn, glm::dvec3(0, 0, 1));
        const auto scene = scene_of(std::vector<Thing>{thing});
        int missed = 0;
        for (float y = -63; y <= 63; y += 0.5f) {
            for (float x = -63; x <= 63; x += 0.5f)
                missed += column(*scene, {640 + x, -1280 + y}).empty() ? 1 : 0;
        }
        EXPECT_EQ(missed, 0) << "turned by " << turn;
    }
}

TEST(Column, GridOfTilesHasNoGapAtItsBorders) {
    std::vector<Thing> things;
    for (int j = -2; j < 2; ++j) {
        for (int i = -2; i < 2; ++i) {
            things.push_back(thing_of(quad({0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0})));
            things.back().world_from_shape = glm::translate(glm::dmat4(1), glm::dvec3(10 * i, 10 * j, 3));
        }
    }
    const auto scene = scene_of(things);
    for (int y = -20; y <= 20; ++y) {
        for (int x = -20; x <= 20; ++x) {
            const std::vector<ColumnHit> hits = column(*scene, {x, y});
            ASSERT_FALSE(hits.empty()) << x << " " << y;
            for (const ColumnHit& hit : hits)
                EXPECT_EQ(hit.z_m, 3);
        }
    }
}

}  // namespace
}  // namespace drtv::test
