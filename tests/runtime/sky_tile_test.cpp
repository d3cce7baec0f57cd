// Tiles: what they hold, what they darken, and files of them.
#include "tests/format/sectors.h"
#include "tests/runtime/sets.h"

#include <drtv/sky_tile.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace drtv {
namespace {

using test::lattice_sector;
using test::OwnedSet;

SkyTile tile_at(std::int32_t i, std::int32_t j) {
    SkyTile tile;
    tile.i = i;
    tile.j = j;
    tile.z_shift = 2;
    tile.visibility.fill(static_cast<std::uint8_t>(i + 100));
    tile.height.fill(1024);
    return tile;
}

TEST(SkyTile, HoldsTheLowestProbeOfEachColumn) {
    OwnedSet set;
    Sector sector = lattice_sector({0, 0}, 2, 10);
    sector.probes[1].position[2] = 3 * 1024;
    sector.probes[1].sky_visibility = {32767, 16384, 0, 0};
    sector.probes[2].sky_visibility = {0, 0, 0, 0};
    // Column (0, 0) names a higher and the lower probe; column (1, 0) none.
    sector.grid.cells[256 * 7] = 1;
    for (std::size_t z = 0; z < 16; ++z)
        sector.grid.cells[1 + 256 * z] = no_probe;
    const SkyTile tile = sky_tile_of(set.add(sector).view);
    EXPECT_EQ(tile.visibility[0], 128);
    EXPECT_EQ(tile.height[0], 3 * 1024);
    EXPECT_EQ(tile.visibility[1], 255);
    EXPECT_EQ(tile.visibility[2], 255);
    EXPECT_EQ(tile.height[2], 10 * 1024);
    EXPECT_EQ(tile.visibility[16 * 15], 0);
}

TEST(SkyTile, ProbesOfInteriorsCountOnlyWhereThereIsNoOther) {
    OwnedSet set;
    Sector sector = lattice_sector({0, 0}, 2, 10);
    sector.probes[0].position[2] = 1024;
    sector.probes[0].sky_visibility = {};
    sector.interiors.push_back(test::box_interior({0, 0, 0}, {0, 0, 0}, {4096, 4096, 4096}));
    sector.interiors.back().probe = 0;
    sector.grid.cells[256 * 4] = 3;
    const SkyTile tile = sky_tile_of(set.add(sector).view);
    EXPECT_EQ(tile.visibility[0], 255) << "probe 3, though the interior's is lower";
    EXPECT_EQ(tile.visibility[1], 0) << "nothing but the interior's";
}

TEST(SkyTile, DarkensLessWithTheHeight) {
    SkyTile tile = tile_at(0, 0);
    tile.visibility[5 + 16 * 7] = 51;  // a fifth
    EXPECT_NEAR(sky_factor(tile, 5, 7, 4), 0.2f, 1e-6);
    EXPECT_NEAR(sky_factor(tile, 5, 7, -1000), 0.2f, 1e-6);
    EXPECT_NEAR(sky_factor(tile, 5, 7, 12), 0.6f, 1e-6);
    EXPECT_EQ(sky_factor(tile, 5, 7, 20), 1);
    EXPECT_EQ(sky_factor(tile, 5, 7, 1e30), 1);
    EXPECT_NEAR(sky_factor(tile, 5, 7, std::nan("")), 0.2f, 1e-6);
}

TEST(SkyTile, IsLinearBetweenColumnsAcrossSectors) {
    OwnedSet set;
    Sector dark = lattice_sector({0, 0}, 1, 2);
    dark.probes[0].sky_visibility = {};
    set.add(dark);
    set.add(lattice_sector({1, 0}, 1, 2));
    EXPECT_NEAR(set->sky_factor({62, 30, 2}), 0, 1e-6);
    EXPECT_NEAR(set->sky_factor({63, 30, 2}), 0.25f, 1e-6);
    EXPECT_NEAR(set->sky_factor({64, 30, 2}), 0.5f, 1e-6);
    EXPECT_NEAR(set->sky_factor({66, 30, 2}), 1, 1e-6);
    EXPECT_NEAR(set->sky_factor({30, 64, 2}), 0.5f, 1e-6) << "no sector is as an open one";
    set->drop({0, 0});
    set->retire();
    EXPECT_NEAR(set->sky_factor({63, 30, 2}), 0.25f, 1e-6) << "kept";
}

TEST(SkyTile, ASectorThatWasBakedAnewReplacesItsTile) {
    OwnedSet set({.sectors = 4, .probes = 100, .interiors = 0, .tiles = 2});
    Sector sector = lattice_sector({0, 0}, 1, 2);
    for (const std::int16_t visibility : std::initializer_list<std::int16_t>{32767, 16384, 0, 8192, 32767}) {
        sector.probes[0].sky_visibility = {visibility, visibility, visibility, 0};
        set.add(sector);
        EXPECT_NEAR(set->sky_factor({30, 30, 2}), visibility / 32767.0, 0.003);
        set->drop({0, 0});
        set->retire();
    }
}

// ---- Files

TEST(TileFile, TilesComeBackSortedAndAreFound) {
    std::vector<SkyTile> tiles;
    for (std::int32_t j = -2; j < 3; ++j) {
        for (std::int32_t i = -3; i < 2; ++i)
            tiles.push_back(tile_at(i, j));
    }
    std::shuffle(tiles.begin(), tiles.end(), std::mt19937(4));
    const auto bytes = write_tiles(tiles);
    EXPECT_EQ(bytes.size(), 40 + 25 * 800u);
    std::span<const SkyTile> opened;
    ASSERT_TRUE(open_tiles(bytes, opened).ok());
    ASSERT_EQ(opened.size(), 25u);
    for (const SkyTile& tile : tiles) {
        const SkyTile* found = find_tile(opened, tile.i, tile.j);
        ASSERT_NE(found, nullptr);
        EXPECT_EQ(*found, tile);
    }
    EXPECT_EQ(find_tile(opened, 2, 0), nullptr);
    EXPECT_EQ(find_tile({}, 0, 0), nullptr);
    EXPECT_EQ(write_tiles(opened), bytes);
}

TEST(TileFile, AnEmptyOneIsOne) {
    std::span<const SkyTile> opened;
    const auto bytes = write_tiles({});
    EXPECT_EQ(bytes.size(), 40u);
    EXPECT_TRUE(open_tiles(bytes, opened).ok());
}

TEST(TileFile, EveryChangedBitAndEveryCutIsFound) {
    const std::vector<SkyTile> tiles = {tile_at(0, 0), tile_at(1, 0)};
    const auto good = write_tiles(tiles);
    for (std::size_t bit = 0; bit < good.size() * 8; bit += bit < 700 ? 1 : 37) {
        auto bad = good;
        bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ 1u << bit % 8);
        std::span<const SkyTile> opened;
        const ReadStatus status = open_tiles(bad, opened);
        const bool minor_version = bit / 8 == 6 || bit / 8 == 7;
        ASSERT_FALSE(status.ok()) << bit;
        ASSERT_FALSE(status.message.empty());
        ASSERT_TRUE(opened.empty());
        if (minor_version) {
            EXPECT_EQ(status.error, ReadError::checksum_mismatch);
        }
    }
    for (std::size_t size = 0; size < good.size(); size += 7) {
        std::span<const SkyTile> opened;
        ASSERT_FALSE(open_tiles(std::span(good).first(size), opened).ok());
    }
}

TEST(TileFile, TilesOutOfTheWorldOrOutOfOrderAreRefused) {
    const auto refused = [](const std::vector<SkyTile>& tiles, const std::string& words) {
        std::span<const SkyTile> opened;
        const ReadStatus status = open_tiles(write_tiles(tiles), opened);
        EXPECT_EQ(status.error, ReadError::bad_section);
        EXPECT_NE(status.message.find(words), std::string::npos) << status.message;
    };
    refused({tile_at(16385, 0)}, "(16385, 0)");
    refused({tile_at(0, 0), tile_at(0, 0)}, "does not stand behind");
    SkyTile high = tile_at(0, 0);
    high.z_origin_units = (1 << 30) + 1;
    refused({high}, "z origin");
    SkyTile shifted = tile_at(0, 0);
    shifted.z_shift = 11;
    refused({shifted}, "z shift 11");
    SkyTile reserved = tile_at(0, 0);
    reserved.reserved[18] = 1;
    refused({reserved}, "reserved");
}

TEST(TileFile, ServesPlacesWhoseSectorsWereNeverLoaded) {
    SkyTile half = tile_at(5, 5);
    half.visibility.fill(0);
    half.z_shift = 0;
    half.height.fill(2 * 1024);
    const auto bytes = write_tiles({&half, 1});
    std::span<const SkyTile> opened;
    ASSERT_TRUE(open_tiles(bytes, opened).ok());
    OwnedSet set;
    set->use_tiles(opened);
    EXPECT_EQ(set->sky_factor({5 * 64 + 30, 5 * 64 + 30, 2}), 0);
    EXPECT_EQ(set->sky_factor({5 * 64 + 30, 5 * 64 + 30, 10}), 0.5f);
    // The sector itself knows better.
    set.add(lattice_sector({5, 5}, 1, 2));
    EXPECT_EQ(set->sky_factor({5 * 64 + 30, 5 * 64 + 30, 2}), 1);
}

}  // namespace
}  // namespace drtv
