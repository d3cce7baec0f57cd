// Probes of interiors light nothing outside.
#include "tests/format/sectors.h"
#include "tests/runtime/sets.h"

#include <drtv/ambient.h>

#include <gtest/gtest.h>

#include <vector>

namespace drtv {
namespace {

using test::OwnedSet;

// 4 x 4 probes, 16 m apart: numbers 5 and 6 inside a room that names 5 and holds 6 too; all dark but for 4,
// the one nearest to 5, and 7, the one nearest to 6.
Sector with_room() {
    Sector sector = test::lattice_sector({0, 0}, 4, 2);
    for (std::size_t p = 0; p < sector.probes.size(); ++p) {
        const auto seen = static_cast<std::int16_t>(p == 4 ? 32767 : p == 7 ? 16384 : 0);
        sector.probes[p].sky_visibility = {seen, seen, seen, 0};
    }
    sector.probes[5].position[0] = 20 * 1024;
    sector.probes[6].position[0] = 44 * 1024;
    sector.interiors.push_back(
        test::box_interior({18 * 1024, 18 * 1024, 0}, {0, 0, 0}, {28 * 1024, 12 * 1024, 4096}));
    sector.interiors.back().probe = 5;
    return sector;
}

TEST(Outdoors, TheNearestThatIsNoneStandsIn) {
    OwnedSet set;
    const LoadedSector& sector = set.add(with_room());
    for (std::size_t p = 0; p < 16; ++p)
        EXPECT_EQ(set->outdoor_probes(sector)[p], p == 5 ? 4 : p == 6 ? 7 : p) << p;
    const ProbeBlend blend = set->outdoors(set->nearest({24, 24, 2}));
    ASSERT_EQ(blend.count, 1u);
    EXPECT_EQ(blend.probes[0].probe, 4);
    EXPECT_EQ(blend.status, PlaceStatus::inside);
    EXPECT_EQ(set->outdoors(set->nearest({200, 0, 0})).status, PlaceStatus::sector_missing);
}

TEST(Outdoors, WhereAllAreInteriorsProbesTheyStandForThemselves) {
    OwnedSet set;
    Sector sector = with_room();
    sector.interiors.push_back(
        test::box_interior({-1024, -1024, -1024}, {0, 0, 0}, {65535, 65535, 16 * 1024}));
    sector.interiors.back().probe = 0;
    sector.interiors.back().shift = 1;
    const LoadedSector& loaded = set.add(sector);
    for (std::size_t p = 0; p < 16; ++p)
        EXPECT_EQ(set->outdoor_probes(loaded)[p], p);
}

TEST(Outdoors, PlacesInTheRoomsCellsAreLitAsOutside) {
    OwnedSet set;
    set.add(with_room());
    SceneLight light;
    light.sky = constant_sky({1, 1, 1});
    const auto lit = [&](const Double3& at, bool interiors) {
        return ambient_at(*set, light, {}, {.at = at, .sampling = Sampling::nearest, .interiors = interiors})
            .colour[0];
    };
    const Double3 beside_the_room = {17, 24, 2};  // in a cell of probe 5
    EXPECT_EQ(lit(beside_the_room, false), 0);
    EXPECT_GT(lit(beside_the_room, true), 0.7f);
    EXPECT_EQ(lit({24, 24, 2}, true), 0) << "inside it is probe 5 alone";
    const Ambient ambient = ambient_at(*set, light, {}, {.at = beside_the_room});
    EXPECT_EQ(ambient.probe.probe, 5) << "what the grid names";
}

TEST(Outdoors, AVolumeShowsThemWhereItIsAskedTo) {
    OwnedSet set;
    const LoadedSector& sector = set.add(with_room());
    SceneLight light;
    light.sky = constant_sky({1, 1, 1});
    const SectorSetLimits& limits = set->limits();
    test::OwnedRelit relit(limits);
    relit->set_light(Shown::now, light);
    relit->relight(Shown::now, sector, light, {});
    for (const bool blur : {false, true}) {
        for (const bool outdoors : {false, true}) {
            VolumeSettings settings;
            settings.size = {24, 24, 8};
            settings.encoding = TexelEncoding::rgba16f;
            settings.outdoors = outdoors;
            settings.blur = blur;
            test::OwnedVolume volume(settings, limits);
            volume->update(*set, *relit, {24, 24, 2});
            const float red = volume->sample({22, 22, 2}).colours[0][0];
            EXPECT_EQ(red > 0.7f, outdoors) << blur;
        }
    }
}

}  // namespace
}  // namespace drtv
