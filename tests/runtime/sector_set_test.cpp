// Sets of sectors: loading and dropping, and the questions about places, against slow ways to answer them.
#include "tests/format/allocation_count.h"
#include "tests/format/sectors.h"
#include "tests/runtime/sets.h"

#include <drtv/sector_set.h>
#include <drtv/write.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <thread>

namespace drtv {
namespace {

using test::lattice_sector;
using test::OwnedSet;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// ---- Loading

TEST(SectorSet, LoadsFindsDropsAndTakesAgainAfterRetire) {
    OwnedSet set;
    const auto file = write_sector(lattice_sector({3, -4}, 2, 2));
    EXPECT_EQ(set->find({3, -4}), nullptr);
    EXPECT_EQ(set->load(file), LoadStatus::loaded);
    EXPECT_EQ(set->load(file), LoadStatus::already_there);
    ASSERT_NE(set->find({3, -4}), nullptr);
    EXPECT_EQ(set->find({3, -4})->view.probe_count, 4u);
    EXPECT_EQ(set->find({-4, 3}), nullptr);
    EXPECT_FALSE(set->drop({3, -5}));
    EXPECT_TRUE(set->drop({3, -4}));
    EXPECT_EQ(set->find({3, -4}), nullptr);
    EXPECT_EQ(set->load(file), LoadStatus::already_there) << "its bytes are still in use";
    set->retire();
    EXPECT_EQ(set->load(file), LoadStatus::loaded);
}

TEST(SectorSet, SaysWhyAFileCannotBeRead) {
    OwnedSet set;
    auto file = write_sector(lattice_sector({0, 0}, 2, 2));
    file[100] ^= 1;
    ReadStatus why;
    EXPECT_EQ(set->load(file, nullptr, &why), LoadStatus::unreadable);
    EXPECT_EQ(why.error, ReadError::checksum_mismatch);
    EXPECT_EQ(set->load({}, nullptr, &why), LoadStatus::unreadable);
}

TEST(SectorSet, LimitsAreKept) {
    const auto file = [](std::int32_t i, std::size_t side) {
        return write_sector(lattice_sector({i, 0}, side, 2));
    };
    const auto a = file(0, 2), b = file(1, 2), c = file(2, 2), large = file(3, 4);
    OwnedSet few({.sectors = 2, .probes = 100, .interiors = 0, .tiles = 1});
    EXPECT_EQ(few->load(a), LoadStatus::loaded);
    EXPECT_EQ(few->load(b), LoadStatus::loaded);
    EXPECT_EQ(few->load(c), LoadStatus::no_room);
    EXPECT_NE(few->tile({0, 0}), nullptr);
    EXPECT_EQ(few->tile({1, 0}), nullptr) << "there was no room for its tile";
    OwnedSet small({.sectors = 8, .probes = 15, .interiors = 0, .tiles = 0});
    EXPECT_EQ(small->load(large), LoadStatus::no_room);
    EXPECT_EQ(small->load(a), LoadStatus::loaded);
    EXPECT_EQ(small->load(b), LoadStatus::loaded);
    EXPECT_EQ(small->load(c), LoadStatus::loaded);
    EXPECT_EQ(small->tile({0, 0}), nullptr);
}

TEST(SectorSet, RunsOfProbesDoNotOverlapInAnyOrderOfLoadsAndDrops) {
    constexpr std::uint32_t limit = 300;
    OwnedSet set({.sectors = 12, .probes = limit, .interiors = 0, .tiles = 0});
    std::map<std::int32_t, std::vector<std::uint8_t>> files;
    for (std::int32_t i = 0; i < 20; ++i) {
        constexpr std::size_t sides[] = {1, 2, 4, 8};
        files[i] = write_sector(lattice_sector({i, 0}, sides[i % 4], 2));
    }
    std::mt19937 engine(3);
    std::size_t loads = 0;
    for (int step = 0; step < 2000; ++step) {
        const auto i = static_cast<std::int32_t>(engine() % 20);
        if (engine() % 3 == 0)
            set->drop({i, 0});
        else if (engine() % 8 == 0)
            set->retire();
        else
            loads += set->load(files[i]) == LoadStatus::loaded ? 1u : 0u;
        std::vector<bool> taken(limit);
        for (std::uint32_t slot = 0; slot < 12; ++slot) {
            const LoadedSector* sector = set->at(slot);
            if (sector == nullptr)
                continue;
            ASSERT_EQ(set->find({sector->view.i, 0}), sector);
            for (std::uint32_t p = 0; p < sector->view.probe_count; ++p) {
                ASSERT_LT(sector->first_probe + p, limit);
                ASSERT_FALSE(taken[sector->first_probe + p]);
                taken[sector->first_probe + p] = true;
            }
        }
    }
    EXPECT_GT(loads, 200u);
}

TEST(SectorSet, AllocatesNothingAfterItIsMade) {
    OwnedSet set;
    const auto file = write_sector(test::random_sector_1_2(1, 40));
    const Sector sector = test::random_sector_1_2(1, 40);
    const Double3 at = {64.0 * sector.i + 20, 64.0 * sector.j + 30, 5};
    const std::size_t before = test::allocation_count();
    ASSERT_EQ(set->load(file), LoadStatus::loaded);
    (void)set->nearest(at);
    (void)set->trilinear(at);
    (void)set->interior(at);
    (void)set->sky_factor(at);
    std::array<SectorId, 60> wanted;
    (void)wanted_sectors(at, 300, wanted);
    set->drop({sector.i, sector.j});
    set->retire();
    EXPECT_EQ(test::allocation_count(), before);
}

// ---- Places

// The same by the page alone: cell by cell.
struct SlowBlend {
    std::map<std::pair<const LoadedSector*, int>, double> shares;
    double fallback = 0;
};

SlowBlend slow_trilinear(SectorSet& set, const Double3& at) {
    SlowBlend blend;
    for (int n = 0; n < 8; ++n) {
        double share = 1;
        std::array<double, 2> column{};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const double u = at[axis] / 4 - 0.5;
            const double above = u - std::floor(u);
            const bool next = (n >> axis & 1) != 0;
            share *= next ? above : 1 - above;
            column[axis] = std::floor(u) + (next ? 1 : 0);
        }
        const SectorId id = {static_cast<std::int32_t>(std::floor(column[0] / 16)),
                             static_cast<std::int32_t>(std::floor(column[1] / 16))};
        const LoadedSector* sector = set.find(id);
        if (sector == nullptr) {
            blend.fallback += share / 2;  // asked for twice, for the two heights
            continue;
        }
        const StoredGrid& grid = *sector->view.grid;
        const double w =
            std::clamp((at[2] * 1024 - grid.z_origin_units) / grid.cell_height_units - 0.5, 0.0, 15.0);
        const double above = w - std::floor(w);
        const bool next = (n & 4) != 0;
        const double cell_z = std::min(std::floor(w) + (next ? 1 : 0), 15.0);
        const double cx = column[0] - 16.0 * id.i, cy = column[1] - 16.0 * id.j;
        const auto cell = static_cast<std::size_t>(cx + 16 * cy + 256 * cell_z);
        const std::uint8_t p = grid.cells[cell];
        const double part = share * (next ? above : 1 - above);
        if (p < sector->view.probe_count)
            blend.shares[{sector, p}] += part;
        else
            blend.fallback += part;
    }
    return blend;
}

// Nine sectors around (0, 0) of random probes and grids of different heights, but for one that is missing and
// one that has no probes.
void add_random_region(OwnedSet& set) {
    for (std::int32_t j = -1; j <= 1; ++j) {
        for (std::int32_t i = -1; i <= 1; ++i) {
            if (i == 1 && j == 1)
                continue;
            const bool empty = i == -1 && j == 0;
            Sector sector = test::random_sector(static_cast<std::uint32_t>(i + 10 * j + 50), empty ? 0 : 60);
            sector.i = i;
            sector.j = j;
            sector.grid.z_origin_units = 1024 * (3 * i - 2 * j);
            sector.grid.cell_height_units = static_cast<std::uint32_t>(1024 + 300 * (j + 1));
            if (i == 0 && j == -1) {
                for (std::size_t n = 0; n < grid_cell_count; n += 3)
                    sector.grid.cells[n] = no_probe;
            }
            set.add(sector);
        }
    }
}

std::vector<Double3> random_places(std::size_t count) {
    std::mt19937 engine(9);
    std::uniform_real_distribution<double> side(-80, 144), height(-20, 60);
    std::vector<Double3> places;
    for (std::size_t n = 0; n < count; ++n)
        places.push_back({side(engine), side(engine), height(engine)});
    return places;
}

TEST(SectorSet, TrilinearIsEightCellsAroundThePlace) {
    OwnedSet set;
    add_random_region(set);
    std::array<std::size_t, 4> of_status{};
    for (const Double3& at : random_places(4000)) {
        const ProbeBlend blend = set->trilinear(at);
        const SlowBlend expected = slow_trilinear(*set, at);
        ASSERT_NEAR(blend.fallback, expected.fallback, 1e-5);
        double sum = static_cast<double>(blend.fallback);
        for (std::size_t n = 0; n < blend.count; ++n) {
            const ProbeShare& probe = blend.probes[n];
            const auto found = expected.shares.find({probe.sector, probe.probe});
            ASSERT_NE(found, expected.shares.end());
            ASSERT_NEAR(probe.share, found->second, 1e-5);
            sum += static_cast<double>(probe.share);
        }
        ASSERT_NEAR(sum, 1, 1e-5);
        const bool only_fallback = blend.count == 0;
        ASSERT_EQ(blend.status == PlaceStatus::inside, blend.fallback == 0);
        ASSERT_EQ(blend.status == PlaceStatus::fading, blend.fallback > 0 && !only_fallback);
        ++of_status[static_cast<std::size_t>(blend.status)];
    }
    for (const std::size_t count : of_status)
        EXPECT_GT(count, 50u);
}

TEST(SectorSet, NearestIsWhatTheGridNames) {
    OwnedSet set;
    add_random_region(set);
    for (const Double3& at : random_places(4000)) {
        const SectorId id = {static_cast<std::int32_t>(std::floor(at[0] / 64)),
                             static_cast<std::int32_t>(std::floor(at[1] / 64))};
        const LoadedSector* sector = set->find(id);
        const ProbeBlend blend = set->nearest(at);
        if (sector == nullptr) {
            ASSERT_EQ(blend.status, PlaceStatus::sector_missing);
            continue;
        }
        const std::uint8_t p = find_probe(sector->view, at);
        if (p == no_probe) {
            ASSERT_EQ(blend.status, PlaceStatus::probe_missing);
            ASSERT_EQ(blend.fallback, 1);
        } else {
            ASSERT_EQ(blend.status, PlaceStatus::inside);
            ASSERT_EQ(blend.count, 1u);
            ASSERT_EQ(blend.probes[0].probe, p);
        }
    }
}

// Along any line, over borders, holes and grid tops.
TEST(SectorSet, TrilinearIsContinuous) {
    OwnedSet set;
    add_random_region(set);
    std::mt19937 engine(4);
    constexpr double step_m = 0.1;
    for (int line = 0; line < 60; ++line) {
        const auto places = random_places(2000);
        Double3 at = places[engine() % places.size()];
        const Double3 towards = places[engine() % places.size()];
        const double length = std::hypot(towards[0] - at[0], towards[1] - at[1], towards[2] - at[2]);
        std::map<std::pair<const LoadedSector*, int>, float> before;
        for (double done = 0; done < length; done += step_m) {
            std::map<std::pair<const LoadedSector*, int>, float> now;
            const ProbeBlend blend = set->trilinear(at);
            for (std::size_t n = 0; n < blend.count; ++n)
                now[{blend.probes[n].sector, blend.probes[n].probe}] = blend.probes[n].share;
            now[{nullptr, 0}] = blend.fallback;
            if (done > 0) {
                double change = 0;
                for (const auto& [probe, share] : now)
                    change += static_cast<double>(std::abs(share - before[probe]));
                // Cells are 4 m wide and at least 1 m high: at most 1/40 an axis in x, y and 1/10 in z go
                // over.
                ASSERT_LT(change, 2 * (2 * step_m / 4 + step_m) + 1e-3);
            }
            before = now;
            for (std::size_t axis = 0; axis < 3; ++axis)
                at[axis] += (towards[axis] - at[axis]) / std::max(length - done, step_m) * step_m;
        }
    }
}

TEST(SectorSet, PlacesThatAreNoneGiveTheFallback) {
    OwnedSet set;
    add_random_region(set);
    for (const Double3& at :
         {Double3{nan, 0, 0}, {0, nan, 0}, {INFINITY, 0, 0}, {0, -INFINITY, 0}, {1e9, 0, 0}, {0, 1e300, 5}}) {
        for (const ProbeBlend& blend : {set->nearest(at), set->trilinear(at)}) {
            EXPECT_EQ(blend.status, PlaceStatus::sector_missing);
            EXPECT_EQ(blend.count, 0u);
            EXPECT_EQ(blend.fallback, 1);
        }
        EXPECT_EQ(set->interior(at).sector, nullptr);
        EXPECT_EQ(set->sky_factor(at), 1);
    }
    for (const double height : {nan, 1e300, -1e300, static_cast<double>(INFINITY)}) {
        const ProbeBlend blend = set->trilinear({10, 10, height});
        EXPECT_EQ(blend.status, PlaceStatus::inside);
        EXPECT_EQ(set->nearest({10, 10, height}).status, PlaceStatus::inside);
    }
}

TEST(SectorSet, TheSameFarOutAsAtTheOrigin) {
    OwnedSet near, far;
    constexpr std::int32_t away = 1600;  // 102 km
    const Sector sector = test::random_sector(8, 50);
    Sector moved = sector;
    moved.i += away;
    moved.j -= away;
    near.add(sector);
    far.add(moved);
    for (const Double3& at : random_places(500)) {
        const Double3 a = {at[0] + 64.0 * sector.i, at[1] + 64.0 * sector.j, at[2]};
        const ProbeBlend one = near->trilinear(a);
        const ProbeBlend other = far->trilinear({a[0] + 64.0 * away, a[1] - 64.0 * away, a[2]});
        ASSERT_EQ(one.count, other.count);
        for (std::size_t n = 0; n < one.count; ++n) {
            ASSERT_EQ(one.probes[n].probe, other.probes[n].probe);
            ASSERT_NEAR(one.probes[n].share, other.probes[n].share, 1e-5);
        }
    }
}

// ---- Interiors

// A box of 8 x 8 x 4 m around (16, 16, 2) in sector (0, 0).
Sector sector_with_box(SectorId id, std::int32_t corner_x_m) {
    Sector sector = lattice_sector(id, 2, 2);
    sector.interiors.push_back(
        test::box_interior({corner_x_m * 1024, 12 * 1024, 0}, {0, 0, 0}, {8 * 1024, 8 * 1024, 4 * 1024}));
    sector.interiors.back().probe = 1;
    return sector;
}

TEST(SectorSet, InteriorsFadeWithTheDistanceToTheirMesh) {
    OwnedSet set;
    set.add(sector_with_box({0, 0}, 12));
    EXPECT_EQ(set->interior({16, 16, 2}).share, 1);
    EXPECT_EQ(set->interior({16, 16, 2}).index, 0u);
    EXPECT_NEAR(set->interior({12, 16, 2}).share, 0.5f, 1e-6);
    EXPECT_NEAR(set->interior({12.2, 16, 2}).share, 0.7f, 1e-6);
    EXPECT_NEAR(set->interior({11.8, 16, 2}).share, 0.3f, 1e-6);
    EXPECT_NEAR(set->interior({12 - 0.15, 12 - 0.2, 2}).share, 0.25f, 1e-6) << "an edge";
    EXPECT_EQ(set->interior({11.4, 16, 2}).sector, nullptr);
    EXPECT_NEAR(set->interior({11.4, 16, 2}, 2).share, 0.2f, 1e-6);
    EXPECT_EQ(set->interior({12.1, 16, 2}, 0).share, 1);
    EXPECT_EQ(set->interior({11.9, 16, 2}, 0).sector, nullptr);
    EXPECT_EQ(set->interior({11.9, 16, 2}, NAN).sector, nullptr);
}

TEST(SectorSet, TheOwnSectorsInteriorComesFirst) {
    OwnedSet set;
    // The one of sector (1, 0) reaches into (0, 0) and is loaded first.
    set.add(sector_with_box({1, 0}, 60));
    const LoadedSector& own = set.add(sector_with_box({0, 0}, 58));
    EXPECT_EQ(set->interior({62.5, 16, 2}).sector, &own);
    EXPECT_EQ(set->interior({64.5, 16, 2}).sector, set->find({1, 0}));
    EXPECT_EQ(set->interior({67, 16, 2}).sector, set->find({1, 0}));
    set->drop({1, 0});
    EXPECT_EQ(set->interior({67, 16, 2}).sector, nullptr);
}

// ---- Wanted

TEST(WantedSectors, AreAllWithinTheRadiusNearestFirst) {
    std::mt19937 engine(12);
    std::uniform_real_distribution<double> coordinate(-500, 500), radii(0, 400);
    for (int n = 0; n < 200; ++n) {
        const Double3 camera = {coordinate(engine), coordinate(engine), 3};
        const double radius = radii(engine);
        std::vector<std::pair<double, SectorId>> expected;
        for (std::int32_t j = -20; j < 20; ++j) {
            for (std::int32_t i = -20; i < 20; ++i) {
                const double dx = std::max({64.0 * i - camera[0], camera[0] - 64.0 * (i + 1), 0.0});
                const double dy = std::max({64.0 * j - camera[1], camera[1] - 64.0 * (j + 1), 0.0});
                if (dx * dx + dy * dy <= radius * radius)
                    expected.push_back({dx * dx + dy * dy, {i, j}});
            }
        }
        std::sort(expected.begin(), expected.end(), [](const auto& a, const auto& b) {
            return std::tuple(a.first, a.second.j, a.second.i) < std::tuple(b.first, b.second.j, b.second.i);
        });
        const std::size_t room = engine() % 3 == 0 ? 10 : 300;
        std::vector<SectorId> found(room);
        found.resize(wanted_sectors(camera, radius, found));
        ASSERT_EQ(found.size(), std::min(expected.size(), room));
        for (std::size_t k = 0; k < found.size(); ++k)
            ASSERT_EQ(found[k], expected[k].second) << k;
    }
}

TEST(WantedSectors, OfNoPlaceOrBeyondTheWorldAreNone) {
    std::array<SectorId, 51> out;
    EXPECT_EQ(wanted_sectors({nan, 0, 0}, 100, out), 0u);
    EXPECT_EQ(wanted_sectors({0, INFINITY, 0}, 100, out), 0u);
    EXPECT_EQ(wanted_sectors({1e9, 0, 0}, 100, out), 0u);
    EXPECT_EQ(wanted_sectors({0, 0, 0}, nan, out), 0u);
    EXPECT_EQ(wanted_sectors({0, 0, 0}, -1, out), 0u);
    EXPECT_EQ(wanted_sectors({0, 0, 0}, 1e300, out), 51u);
    EXPECT_EQ(wanted_sectors({0, 0, 0}, 100, {}), 0u);
    const double edge = 64.0 * 16385;
    const std::size_t count = wanted_sectors({edge - 1, 0.5, 0}, 100, out);
    ASSERT_GT(count, 0u);
    for (std::size_t n = 0; n < count; ++n)
        EXPECT_LE(out[n].i, 16384);
}

// ---- Threads (for ThreadSanitizer): four readers and a streamer.

TEST(SectorSet, ReadersRunBesideAStreamer) {
    OwnedSet set({.sectors = 9, .probes = 9 * 64, .interiors = 9, .tiles = 64});
    std::vector<std::vector<std::uint8_t>> files;
    for (std::int32_t n = 0; n < 9; ++n) {
        Sector sector = lattice_sector({n % 3, n / 3}, 8, 2);
        const std::array<std::int32_t, 3> corner = {65536 * sector.i + 20480, 65536 * sector.j + 20480, 0};
        sector.interiors.push_back(test::box_interior(corner, {0, 0, 0}, {16384, 16384, 4096}));
        sector.interiors.back().probe = 27;
        files.push_back(write_sector(sector));
    }
    // Between rounds no reader is at work: there a game retires.
    for (int round = 0; round < 20; ++round) {
        std::atomic<int> working{4};
        std::vector<std::thread> readers;
        for (int reader = 0; reader < 4; ++reader) {
            readers.emplace_back([&, reader] {
                std::mt19937 engine(static_cast<std::uint32_t>(reader));
                std::uniform_real_distribution<double> side(-20, 210);
                for (int n = 0; n < 500; ++n) {
                    const Double3 at = {side(engine), side(engine), 2};
                    const ProbeBlend blend = set->outdoors(set->trilinear(at));
                    float sum = blend.fallback;
                    for (std::size_t k = 0; k < blend.count; ++k)
                        sum += blend.probes[k].share *
                               (blend.probes[k].sector->view.probe_count == 64 ? 1.0f : 9.0f);
                    EXPECT_NEAR(sum, 1, 1e-5);
                    EXPECT_LE(set->sky_factor(at), 1);
                    EXPECT_GE(set->interior(at).share, 0);
                }
                --working;
            });
        }
        std::mt19937 engine(static_cast<std::uint32_t>(100 + round));
        while (working > 0) {
            const std::size_t n = engine() % files.size();
            if (engine() % 2 == 0)
                set->load(files[n]);
            else
                set->drop({static_cast<std::int32_t>(n % 3), static_cast<std::int32_t>(n / 3)});
        }
        for (std::thread& reader : readers)
            reader.join();
        set->retire();
    }
}

}  // namespace
}  // namespace drtv
