// The ambient light at places, and the bounce of lamps.
#include "tests/format/sectors.h"
#include "tests/runtime/sets.h"

#include <drtv/ambient.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace drtv {
namespace {

using test::lattice_sector;
using test::OwnedSet;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

SceneLight daylight(RelightMode mode = RelightMode::accurate) {
    SceneLight light;
    light.mode = mode;
    light.sky = gradient_sky({{0.3f, 0.5f, 1}, {0.5f, 0.5f, 0.6f}, {0.4f, 0.3f, 0.1f}}, {1, 1, 1});
    light.sun = {{2, 2, 1.5f}, {1, 1, 1}};
    return light;
}

Float3 sum_of(const AmbientParts& parts) {
    Float3 sum{};
    for (const Float3* part : {&parts.sky_direct, &parts.sky_bounce, &parts.sun_bounce, &parts.static_light,
                               &parts.local, &parts.fallback}) {
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += (*part)[c];
    }
    return sum;
}

// ---- Places

// Over a plane of albedo r under a sky of 1: E/pi is (1 + z) / 2 from above and r (1 - z) / 2 from below.
TEST(Ambient, OverAPlaneIsExactAtEveryNormal) {
    OwnedSet set;
    Sector sector = lattice_sector({0, 0}, 4, 2);
    test::put_on_plane(sector, {0.5f, 0.25f, 0.125f});
    set.add(sector);
    const SceneLight light{.sky = constant_sky({1, 1, 1})};
    std::mt19937 engine(2);
    std::normal_distribution<float> component;
    for (int n = 0; n < 300; ++n) {
        Float3 normal = {component(engine), component(engine), component(engine)};
        const float length = std::hypot(normal[0], normal[1], normal[2]);
        for (float& x : normal)
            x /= length;
        for (const Sampling sampling : {Sampling::nearest, Sampling::trilinear}) {
            const Ambient ambient = ambient_at(
                *set, light, {}, {.at = {20.0 + n % 20, 30, 2}, .normal = normal, .sampling = sampling});
            EXPECT_EQ(ambient.status, PlaceStatus::inside);
            for (std::size_t c = 0; c < 3; ++c) {
                const float albedo = 0.5f / static_cast<float>(1 << c);
                EXPECT_NEAR(ambient.colour[c], (1 + normal[2]) / 2 + albedo * (1 - normal[2]) / 2, 6e-5);
            }
        }
    }
}

TEST(Ambient, PartsAddUpToTheColourWhereNothingIsBelowZero) {
    OwnedSet set;
    for (std::int32_t i = 0; i < 2; ++i) {
        Sector sector = test::random_sector_1_3(static_cast<std::uint32_t>(40 + i), 60);
        sector.i = i;
        sector.j = 0;
        sector.grid.z_origin_units = 0;
        for (Probe& probe : sector.probes) {
            for (auto& channel : probe.transfer) {
                for (auto& row : channel) {
                    for (std::size_t k = 1; k < 4; ++k)
                        row[k] = static_cast<std::int16_t>(row[k] / 8);
                    row[0] = static_cast<std::int16_t>(std::abs(row[0]));
                }
            }
        }
        set.add(sector);
    }
    SceneLight light = daylight();
    light.other_groups = {0.5f, 1, 2};
    std::array<LightShare, 8> shares;
    const std::size_t count = split_light(*set, {{50, 20, 4}, {3, 2, 1}}, shares);
    ASSERT_GT(count, 0u);
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> side(-20, 150), height(-10, 40);
    std::size_t checked = 0;
    for (int n = 0; n < 2000; ++n) {
        AmbientPlace place{.at = {side(engine), side(engine) / 2, height(engine)}};
        place.sampling = n % 2 == 0 ? Sampling::nearest : Sampling::trilinear;
        const Ambient ambient = ambient_at(*set, light, {shares.data(), count}, place);
        bool clamps = false;
        for (const Float3& colour : ambient.colours)
            clamps = clamps || *std::min_element(colour.begin(), colour.end()) <= 0;
        const Float3 sum = sum_of(ambient.parts);
        const float largest = *std::max_element(sum.begin(), sum.end());
        if (clamps && ambient.parts.fallback == Float3{})
            continue;
        ++checked;
        for (std::size_t c = 0; c < 3; ++c)
            ASSERT_NEAR(std::max(0.0f, sum[c]), ambient.colour[c], 1e-5f * largest) << n;
    }
    EXPECT_GT(checked, 500u);
}

TEST(Ambient, IndoorsTheInteriorsProbeAloneLights) {
    OwnedSet set;
    Sector sector = lattice_sector({0, 0}, 2, 2);
    for (Probe& probe : sector.probes)
        probe.sky_visibility = {32767, 32767, 32767, 0};
    sector.probes[1].sky_visibility = {};
    test::put_on_plane(sector, {0.5f, 0.5f, 0.5f});
    for (auto& channel : sector.probes[1].transfer)
        channel = {};
    sector.interiors.push_back(test::box_interior({12 * 1024, 12 * 1024, 0}, {0, 0, 0}, {8192, 8192, 4096}));
    sector.interiors.back().probe = 1;
    set.add(sector);
    const SceneLight light = daylight();
    const auto red = [&](double x, bool interiors) {
        return ambient_at(*set, light, {}, {.at = {x, 16, 2}, .interiors = interiors}).colour[0];
    };
    EXPECT_EQ(red(16, true), 0) << "no blue inside";
    EXPECT_GT(red(16, false), 0.3f);
    EXPECT_EQ(red(11.4, true), red(11.4, false));
    EXPECT_NEAR(red(12, true), red(12, false) / 2, 1e-5);
    const Ambient inside = ambient_at(*set, light, {}, {.at = {16, 16, 2}});
    EXPECT_EQ(inside.interior.index, 0u);
    EXPECT_NE(inside.interior.sector, nullptr);
}

TEST(Ambient, OffsetAsksAlongTheNormal) {
    OwnedSet set;
    Sector sector = lattice_sector({0, 0}, 2, 2);
    for (std::size_t p = 0; p < 4; ++p)
        sector.probes[p].sky_visibility = {static_cast<std::int16_t>(8000 * p),
                                           static_cast<std::int16_t>(8000 * p),
                                           static_cast<std::int16_t>(8000 * p), 0};
    set.add(sector);
    const auto probe = [&](double x, const Float3& normal, float offset) {
        return ambient_at(*set, daylight(), {}, {.at = {x, 10, 2}, .normal = normal, .offset_m = offset})
            .probe.probe;
    };
    EXPECT_EQ(probe(31, {1, 0, 0}, 0), 0);
    EXPECT_EQ(probe(31, {1, 0, 0}, 2), 1);
    EXPECT_EQ(probe(31, {-1, 0, 0}, 2), 0);
    EXPECT_EQ(probe(31, {1, 0, 0}, nan), 0);
}

TEST(Ambient, NothingIsBlackOrNotANumberWhateverIsAsked) {
    OwnedSet set;
    set.add(lattice_sector({0, 0}, 2, 2));
    const double dnan = static_cast<double>(nan);
    const SceneLight light = daylight();
    for (const Double3& at : {Double3{dnan, 0, 0},
                              {0, dnan, 0},
                              {0, 0, dnan},
                              {1e9, 0, 0},
                              {-1e300, 5, 5},
                              {30, 30, 1e300},
                              {70, 3, 2},
                              {64, 64, 2}}) {
        for (const Float3& normal : {Float3{0, 0, 1}, {0, 0, 0}, {nan, 0, 0}, {1, 0, 0}}) {
            for (const Sampling sampling : {Sampling::nearest, Sampling::trilinear}) {
                const Ambient ambient = ambient_at(
                    *set, light, {}, {.at = at, .normal = normal, .sampling = sampling, .offset_m = 1});
                for (const float channel : ambient.colour) {
                    EXPECT_TRUE(std::isfinite(channel));
                    EXPECT_GT(channel, 0.05f);
                }
            }
        }
    }
}

// ---- Volumes

TEST(Ambient, InAVolumeFadesToTheDistanceAtTheWindowsSides) {
    constexpr SectorSetLimits limits{.sectors = 64, .probes = 64 * 64, .interiors = 8, .tiles = 256};
    OwnedSet set(limits);
    std::vector<std::byte> relit_memory(RelitProbes::memory_bytes(limits, false));
    RelitProbes relit(relit_memory, limits, false);
    const SceneLight light = daylight();
    relit.set_light(Shown::now, light);
    for (std::int32_t j = -2; j < 2; ++j) {
        for (std::int32_t i = -2; i < 2; ++i) {
            Sector sector = lattice_sector({i, j}, 8, 2);
            test::put_on_plane(sector, {0.5f, 0.25f, 0.125f});
            for (Probe& probe : sector.probes)
                probe.sky_visibility = {8000, 9000, 7000, 0};
            relit.relight(Shown::now, set.add(sector), light, {});
        }
    }
    const VolumeSettings settings{.size = {24, 24, 8}, .encoding = TexelEncoding::rgba16f};
    std::vector<std::byte> memory(Volume::memory_bytes(settings, limits));
    Volume volume(memory, settings, limits);
    volume.update(*set, relit, {0, 0, 0});
    Float3 before{};
    for (double x = -60; x < 60; x += 0.1) {
        const AmbientPlace place{.at = {x, 1, 2}, .normal = {0, 0.6f, 0.8f}};
        const Ambient ambient = ambient_in(volume, *set, light, {}, place);
        const Ambient near = ambient_at(*set, light, {}, place);
        const Float3 sum = sum_of(ambient.parts);
        for (std::size_t c = 0; c < 3; ++c) {
            ASSERT_NEAR(sum[c], ambient.colour[c], 1e-3f * ambient.colour[c]);
            if (std::abs(x) < 42) {
                ASSERT_NEAR(ambient.colour[c], near.colour[c], 1e-3f * near.colour[c]);
            }
            if (x > -60) {
                ASSERT_NEAR(ambient.colour[c], before[c], 0.05f * before[c]) << x;
            }
        }
        const PlaceStatus expected = std::abs(x) < 42     ? PlaceStatus::inside
                                     : std::abs(x) < 45.9 ? PlaceStatus::fading
                                                          : PlaceStatus::sector_missing;
        if (std::abs(x) < 41.9 || std::abs(x) > 46.1) {
            ASSERT_EQ(ambient.status, expected) << x;
        }
        before = ambient.colour;
    }
}

// ---- Lamps

// Sources and pairs of all probes of one sector with each other, R = (value, 0, 0, 0).
Sector connected_sector(SectorId id, float value) {
    Sector sector = lattice_sector(id, 4, 2);
    LocalTransfer local;
    for (std::size_t p = 0; p < sector.probes.size(); ++p)
        local.sources.push_back({0, 0, static_cast<std::uint8_t>(p), 0});
    local.receivers.resize(sector.probes.size());
    std::vector<std::size_t> all(sector.probes.size());
    for (std::size_t s = 0; s < all.size(); ++s)
        all[s] = s;
    LightCodes codes{};
    for (auto& channel : codes)
        channel[0] = encode_fixed(value, 1);
    for (std::size_t p = 0; p < sector.probes.size(); ++p)
        test::add_pairs(local, p, all, codes);
    sector.local_transfer = local;
    return sector;
}

TEST(SplitLight, GoesToTheCellsAroundAndAddsUpToTheLamp) {
    OwnedSet set;
    set.add(connected_sector({0, 0}, 0.1f));
    set.add(connected_sector({1, 0}, 0.1f));
    std::mt19937 engine(4);
    std::uniform_real_distribution<double> x(10, 118), y(10, 54), z(0, 15);
    for (int n = 0; n < 500; ++n) {
        const PointLight lamp{{x(engine), y(engine), z(engine)}, {3, 2, 1}};
        std::array<LightShare, 8> shares;
        const std::size_t count = split_light(*set, lamp, shares);
        Float3 sum{};
        for (std::size_t k = 0; k < count; ++k) {
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] += shares[k].intensity[c];
            EXPECT_EQ(shares[k].light, lamp.position);
        }
        EXPECT_NEAR(sum[0], 3, 1e-5);
        EXPECT_NEAR(sum[2], 1, 1e-5);
    }
    std::array<LightShare, 8> shares;
    ASSERT_EQ(split_light(*set, {{8, 8, 2}, {1, 1, 1}}, shares), 1u);
    EXPECT_EQ(shares[0].probe, 0);
    EXPECT_EQ(shares[0].source, (Double3{8, 8, 2}));
}

TEST(SplitLight, LampsThatAreNoneBringNothing) {
    OwnedSet set;
    set.add(connected_sector({0, 0}, 0.1f));
    std::array<LightShare, 8> shares;
    const double dnan = static_cast<double>(nan);
    for (const PointLight& lamp : {PointLight{{dnan, 0, 0}, {1, 1, 1}},
                                   {{0, 0, INFINITY}, {1, 1, 1}},
                                   {{8, 8, 2}, {nan, 1, 1}},
                                   {{8, 8, 2}, {INFINITY, 1, 1}},
                                   {{8, 8, 2}, {0, 0, 0}},
                                   {{1000, 8, 2}, {1, 1, 1}},
                                   {{1e9, 8, 2}, {1, 1, 1}}})
        EXPECT_EQ(split_light(*set, lamp, shares), 0u);
}

TEST(SplitLight, InsideAnInteriorItGoesToItsProbeAloneAndNoneOutsideDoes) {
    OwnedSet set;
    Sector sector = connected_sector({0, 0}, 0.1f);
    sector.interiors.push_back(test::box_interior({4 * 1024, 4 * 1024, 0}, {0, 0, 0}, {8192, 8192, 4096}));
    sector.interiors.back().probe = 0;
    set.add(sector);
    std::array<LightShare, 8> shares;
    ASSERT_EQ(split_light(*set, {{11.9, 8, 2}, {1, 1, 1}}, shares), 1u);
    EXPECT_EQ(shares[0].probe, 0);
    const std::size_t count = split_light(*set, {{15, 8, 2}, {1, 1, 1}}, shares);
    ASSERT_GT(count, 0u);
    float sum = 0;
    for (std::size_t n = 0; n < count; ++n) {
        EXPECT_NE(shares[n].probe, 0);
        sum += shares[n].intensity[0];
    }
    EXPECT_NEAR(sum, 1, 1e-6);
}

// Two rooms, west and east of a wall in the middle of the sector: pairs within each, none between.
Sector two_rooms() {
    Sector sector = connected_sector({0, 0}, 0.1f);
    LocalTransfer apart = *sector.local_transfer;
    apart.pairs.clear();
    for (LocalReceiver& receiver : apart.receivers)
        receiver = {};
    const LightCodes codes = sector.local_transfer->pairs[0];
    for (std::size_t p = 0; p < 16; ++p) {
        std::vector<std::size_t> room;
        for (std::size_t s = 0; s < 16; ++s) {
            if (s % 4 / 2 == p % 4 / 2)
                room.push_back(s);
        }
        test::add_pairs(apart, p, room, codes);
    }
    sector.local_transfer = apart;
    return sector;
}

// The wall stands at x = 32, where cells of both sides have equal shares.
TEST(SplitLight, KeepsToItsSideOfAWall) {
    OwnedSet set, open;
    set.add(two_rooms());
    open.add(connected_sector({0, 0}, 0.1f));
    const auto across = [](OwnedSet& sectors, double x) {
        std::array<LightShare, 8> shares;
        const std::size_t count = split_light(*sectors, {{x, 32, 2}, {1, 1, 1}}, shares);
        float east = 0;
        for (std::size_t n = 0; n < count; ++n)
            east += shares[n].probe % 4 >= 2 ? shares[n].intensity[0] : 0.0f;
        return east;
    };
    EXPECT_NEAR(across(open, 31.5), 0.375, 0.01) << "without a wall";
    EXPECT_LT(across(set, 31.5), 0.02);
    EXPECT_GT(across(set, 32.5), 0.98);
    EXPECT_NEAR(across(set, 32), 0.5, 1e-3);
    float before = across(set, 30);
    for (double x = 30; x < 34; x += 0.01) {
        EXPECT_LT(std::abs(across(set, x) - before), 0.03f) << x;
        before = across(set, x);
    }
}

// At its source a lamp brings I R Y(b); elsewhere what flat ground would make of it.
TEST(LocalRelighter, IsTheSumOverPairsTimesTheFactorOfItsPlace) {
    OwnedSet set;
    const LoadedSector& sector = set.add(connected_sector({0, 0}, 0.25f));
    const Double3 source = {8, 8, 2};
    std::array<LightShare, 8> shares;
    ASSERT_EQ(split_light(*set, {source, {1, 2, 4}}, shares), 1u);
    BasisColours colours{};
    LocalRelighter(sector, {shares.data(), 1}).add_to(colours, 5);
    for (const Float3& colour : colours) {
        EXPECT_NEAR(colour[0], 0.25f * 0.282095f, 1e-5);
        EXPECT_NEAR(colour[2], 0.25f * 0.282095f * 4, 4e-5);
    }
    shares[0].light = {8, 8, 4};
    BasisColours own{};
    LocalRelighter(sector, {shares.data(), 1}).add_to(own, 0);
    EXPECT_NEAR(own[0][0], 0.25f * 0.282095f * (4.0f / 64) / (2.0f / 8), 1e-5)
        << "3 m over the ground, by 1 m";
    shares[0].light = {8.5, 8, 2};
    BasisColours towards{};
    LocalRelighter(sector, {shares.data(), 1}).add_to(towards, 1);
    EXPECT_NEAR(towards[0][0], 0.25f * 0.282095f * 1.09833f, 1e-5) << "(260 / 244.25)^(3/2)";
    shares[0].light = {24, 8, 2};
    BasisColours there{};
    LocalRelighter(sector, {shares.data(), 1}).add_to(there, 1);
    EXPECT_NEAR(there[0][0], 0.25f * 0.282095f * 3, 1e-5) << "never more than three times";
}

TEST(LocalRelighter, ReachesTheNeighboursAndNoFurther) {
    OwnedSet set;
    Sector east = connected_sector({1, 0}, 0.1f);
    for (LocalSource& source : east.local_transfer->sources)
        source.di = -1;  // all of the sector to the west
    const LoadedSector& west = set.add(connected_sector({0, 0}, 0.1f));
    const LoadedSector& neighbour = set.add(east);
    const LoadedSector& far = set.add(connected_sector({2, 0}, 0.1f));
    std::array<LightShare, 8> shares;
    const std::size_t count = split_light(*set, {{30, 30, 2}, {1, 1, 1}}, shares);
    const std::span<const LightShare> split(shares.data(), count);
    EXPECT_FALSE(LocalRelighter(west, split).empty());
    EXPECT_FALSE(LocalRelighter(neighbour, split).empty());
    EXPECT_TRUE(LocalRelighter(far, split).empty());
}

TEST(LocalRelighter, AThousandLampsAreAThousandTimesOne) {
    constexpr SectorSetLimits limits{.sectors = 4, .probes = 64, .interiors = 0, .tiles = 4};
    OwnedSet set(limits);
    const LoadedSector& sector = set.add(connected_sector({0, 0}, 0.2f));
    std::array<LightShare, 8> shares;
    ASSERT_EQ(split_light(*set, {{8, 8, 2}, {1, 2, 3}}, shares), 1u);
    const std::vector<LightShare> many(1000, shares[0]);
    const SceneLight dark;
    const float one = ambient_at(*set, dark, {shares.data(), 1}, {.at = {30, 30, 2}}).colour[1];
    EXPECT_GT(one, 0.01f);
    EXPECT_NEAR(ambient_at(*set, dark, many, {.at = {30, 30, 2}}).colour[1], 1000 * one, 0.01f * one);
    std::vector<std::byte> memory(RelitProbes::memory_bytes(limits, false));
    RelitProbes relit(memory, limits, false);
    relit.relight(Shown::now, sector, dark, {shares.data(), 1});
    const float few = relit.colours(sector, 5)[0][1];
    relit.relight(Shown::now, sector, dark, many);
    EXPECT_NEAR(relit.colours(sector, 5)[0][1], 1000 * few, few);
}

TEST(LocalRelighter, ALampThatMovesChangesColoursInSmallSteps) {
    OwnedSet set;
    const LoadedSector& sector = set.add(connected_sector({0, 0}, 0.2f));
    std::vector<float> before(16);
    float largest = 0, step = 0;
    for (double x = 10; x < 54; x += 0.04) {
        std::array<LightShare, 8> shares;
        const std::size_t count = split_light(*set, {{x, 0.7 * x, 3}, {1, 1, 1}}, shares);
        const LocalRelighter local(sector, {shares.data(), count});
        for (std::size_t p = 0; p < 16; ++p) {
            BasisColours colours{};
            local.add_to(colours, p);
            largest = std::max(largest, colours[0][0]);
            if (x > 10)
                step = std::max(step, std::abs(colours[0][0] - before[p]));
            before[p] = colours[0][0];
        }
    }
    EXPECT_GT(largest, 0);
    EXPECT_LT(step, 0.03f * largest);
}

}  // namespace
}  // namespace drtv
