// The same bytes whatever the threads, the order, and what else is in the scene (docs/design.md, promise 1).
#include "bakerd/bake/sector_bake.h"
#include "tests/bake/worlds.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <map>

namespace drtv::test {
namespace {

// The tower stands beyond the reach of the middle sector.
GltfBuilder with_a_tower_far_away() {
    GltfBuilder b = clutter({});
    b.add_node({.mesh = b.add_mesh(box({-4, 0, -4}, {4, 40, 4}), b.add_material({})),
                .translation = glm::dvec3(150, 0, 150)});
    return b;
}

settings::BakeSettings few_rays() {
    settings::BakeSettings settings;
    settings.rays = 64;
    settings.reach_m = 80;
    settings.local_transfer = true;
    settings.local_rays = 32;
    return settings;
}

settings::BakeSettings until_good_enough() {
    settings::BakeSettings settings = few_rays();
    settings.rays = 1024;
    settings.error = 0.03f;
    return settings;
}

using Files = std::map<map::SectorCoordinate, std::vector<std::uint8_t>>;

Files bake_all(bake::World& world, const settings::BakeSettings& settings, bool backwards) {
    std::vector<map::SectorCoordinate> sectors;
    for (std::int32_t j = -1; j <= 1; ++j) {
        for (std::int32_t i = -1; i <= 1; ++i)
            sectors.push_back({i, j});
    }
    if (backwards)
        std::reverse(sectors.begin(), sectors.end());
    std::vector<std::vector<std::uint8_t>> bytes(sectors.size());
    tbb::parallel_for(std::size_t{0}, sectors.size(), [&](std::size_t n) {
        bytes[n] = encoded(bake::bake_sector(world, sectors[n], settings).value().sector);
    });
    Files files;
    for (std::size_t n = 0; n < sectors.size(); ++n)
        files[sectors[n]] = bytes[n];
    return files;
}

TEST(Determinism, ThreadsAndOrderDoNotMatter) {
    for (const settings::BakeSettings& settings : {few_rays(), until_good_enough()}) {
        Files one, many;
        {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
            one = bake_all(*open_world(clutter({})), settings, false);
        }
        many = bake_all(*open_world(clutter({})), settings, true);
        EXPECT_EQ(one, many);
    }
}

TEST(Determinism, ObjectsBeyondTheReachDoNotMatter) {
    const auto without = open_world(clutter({})), with = open_world(with_a_tower_far_away());
    const map::SectorCoordinate middle{0, 1}, corner{2, -3};
    EXPECT_EQ(bake::bake_sector(*without, middle, few_rays()).value().sector,
              bake::bake_sector(*with, middle, few_rays()).value().sector);
    // The test can fail: next to it the object does matter.
    EXPECT_NE(bake::bake_sector(*without, corner, few_rays()).value().sector,
              bake::bake_sector(*with, corner, few_rays()).value().sector);
}

TEST(Determinism, EqualProbesInMirroredSectorsGetEqualLight) {
    GltfBuilder b;
    b.add_node({.mesh = b.add_mesh(ground(2000), b.add_material({.colour = {0.3f, 0.3f, 0.3f, 1}}))});
    const auto world = open_world(b);
    const auto west = bake::bake_sector(*world, {-1, 0}, few_rays()).value().sector,
               east = bake::bake_sector(*world, {0, 0}, few_rays()).value().sector;
    ASSERT_EQ(west.probes.size(), east.probes.size());
    for (std::size_t p = 0; p < west.probes.size(); ++p) {
        EXPECT_EQ(west.probes[p].position, east.probes[p].position);
        EXPECT_EQ(west.probes[p].sky_visibility, east.probes[p].sky_visibility);
    }
}

}  // namespace
}  // namespace drtv::test
