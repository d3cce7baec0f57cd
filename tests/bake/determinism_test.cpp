// The same bytes whatever the threads, the order, and what else is in the scene (DESIGN, promise 1).
#include "bakerd/bake/sector_bake.h"
#include "tests/bake/worlds.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <map>
#include <random>

namespace drtv::test {
namespace {

// Hills, blocks and trees over 3 x 3 sectors; `extra` stands beyond the reach of the middle one.
GltfBuilder clutter(bool extra) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(-90, 150), height(2, 9);
    GltfBuilder b;
    const int grass = b.add_material({.colour = {0.2f, 0.4f, 0.1f, 1}}), stone = b.add_material({.colour = {0.5f, 0.45f, 0.4f, 1}}), leaf = b.add_material({.colour = {0.1f, 0.3f, 0.05f, 1}});
    b.add_node({.mesh = b.add_mesh(ground(200), grass)});
    const int block = b.add_mesh(box({-2, 0, -2}, {2, 5, 2}), stone), crown = b.add_mesh(box({-1.5f, 2, -1.5f}, {1.5f, 6, 1.5f}), leaf);
    for (int n = 0; n < 25; ++n) b.add_node({.mesh = block, .translation = glm::dvec3(place(random), -1, -place(random)), .rotation = glm::dvec4(0, std::sin(n), 0, std::cos(n))});
    for (int n = 0; n < 60; ++n) b.add_node({.mesh = crown, .translation = glm::dvec3(place(random), 0, -place(random)), .scale = glm::dvec3(1, height(random) / 6, 1), .role = "vegetation"});
    // Twice the same block: every hit on it is a tie.
    for (int n = 0; n < 2; ++n) b.add_node({.mesh = block, .translation = glm::dvec3(32, 0, -32)});
    // All that a sector can hold: lamps, a glowing block, and local transfer.
    const int glow = b.add_material({});
    b.json["materials"][static_cast<std::size_t>(glow)]["emissiveFactor"] = {1, 0.5, 0.25};
    b.json["materials"][static_cast<std::size_t>(glow)]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 5000;
    b.add_node({.mesh = b.add_mesh(box({-1, 2, -1}, {1, 3, 1}), glow), .translation = glm::dvec3(20, 0, 10)});
    for (int n = 0; n < 12; ++n) b.add_node({.light = b.add_light({{"type", "point"}, {"intensity", 400 + 10 * n}}), .translation = glm::dvec3(place(random), 3, -place(random))});
    if (extra) b.add_node({.mesh = block, .translation = glm::dvec3(150, 0, 150), .scale = glm::dvec3(2, 8, 2)});
    return b;
}

bake::Settings few_rays() {
    bake::Settings settings;
    settings.rays = 64;
    settings.reach_m = 80;
    settings.local_transfer = true;
    settings.local_rays = 32;
    return settings;
}

bake::Settings until_good_enough() {
    bake::Settings settings = few_rays();
    settings.rays = 1024;
    settings.error = 0.03f;
    return settings;
}

using Files = std::map<map::SectorCoordinate, std::vector<std::uint8_t>>;

Files bake_all(bake::World& world, const bake::Settings& settings, bool backwards) {
    std::vector<map::SectorCoordinate> sectors;
    for (std::int32_t j = -1; j <= 1; ++j) {
        for (std::int32_t i = -1; i <= 1; ++i) sectors.push_back({i, j});
    }
    if (backwards) std::reverse(sectors.begin(), sectors.end());
    std::vector<std::vector<std::uint8_t>> bytes(sectors.size());
    tbb::parallel_for(std::size_t{0}, sectors.size(), [&](std::size_t n) { bytes[n] = encoded(bake::bake_sector(world, sectors[n], settings).value().sector); });
    Files files;
    for (std::size_t n = 0; n < sectors.size(); ++n) files[sectors[n]] = bytes[n];
    return files;
}

TEST(Determinism, ThreadsAndOrderDoNotMatter) {
    for (const bake::Settings& settings : {few_rays(), until_good_enough()}) {
        Files one, many;
        {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
            one = bake_all(*open_world(clutter(false)), settings, false);
        }
        many = bake_all(*open_world(clutter(false)), settings, true);
        EXPECT_EQ(one, many);
    }
}

TEST(Determinism, ObjectsBeyondTheReachDoNotMatter) {
    const auto without = open_world(clutter(false)), with = open_world(clutter(true));
    const map::SectorCoordinate middle{0, 1}, corner{2, -3};
    EXPECT_EQ(bake::bake_sector(*without, middle, few_rays()).value().sector, bake::bake_sector(*with, middle, few_rays()).value().sector);
    // The test can fail: next to it the object does matter.
    EXPECT_NE(bake::bake_sector(*without, corner, few_rays()).value().sector, bake::bake_sector(*with, corner, few_rays()).value().sector);
}

TEST(Determinism, EqualProbesInMirroredSectorsGetEqualLight) {
    GltfBuilder b;
    b.add_node({.mesh = b.add_mesh(ground(2000), b.add_material({.colour = {0.3f, 0.3f, 0.3f, 1}}))});
    const auto world = open_world(b);
    const auto west = bake::bake_sector(*world, {-1, 0}, few_rays()).value().sector, east = bake::bake_sector(*world, {0, 0}, few_rays()).value().sector;
    ASSERT_EQ(west.probes.size(), east.probes.size());
    for (std::size_t p = 0; p < west.probes.size(); ++p) {
        EXPECT_EQ(west.probes[p].position, east.probes[p].position);
        EXPECT_EQ(west.probes[p].sky_visibility, east.probes[p].sky_visibility);
    }
}

}  // namespace
}  // namespace drtv::test
