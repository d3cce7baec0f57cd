// Sectors used where they lie: the same numbers as a reader gives, and not one allocation.
#include "tests/format/allocation_count.h"
#include "tests/format/sector_bytes.h"
#include "tests/format/sectors.h"

#include <drtv/view.h>
#include <drtv/write.h>

#include <gtest/gtest.h>

#include <limits>

namespace drtv::test {
namespace {

SectorView open(const Bytes& file) {
    SectorView view;
    const ReadStatus status = open_sector(file, view);
    EXPECT_TRUE(status.ok()) << status.message;
    return view;
}

void expect_equal(const SectorView& view, const Sector& sector) {
    EXPECT_EQ(view.i, sector.i);
    EXPECT_EQ(view.j, sector.j);
    EXPECT_EQ(view.z_origin_units, sector.z_origin_units);
    EXPECT_EQ(view.z_shift, sector.z_shift);
    ASSERT_EQ(view.probe_count, sector.probes.size());
    for (std::size_t p = 0; p < view.probe_count; ++p) {
        EXPECT_EQ(view.positions[p].position, sector.probes[p].position);
        EXPECT_EQ(view.positions[p].kind, sector.probes[p].kind);
        EXPECT_EQ(view.sky_visibility[p], sector.probes[p].sky_visibility);
        EXPECT_EQ(view.transfer[p], sector.probes[p].transfer);
    }
    EXPECT_EQ(view.grid->z_origin_units, sector.grid.z_origin_units);
    EXPECT_EQ(view.grid->cell_height_units, sector.grid.cell_height_units);
    EXPECT_EQ(view.grid->cells, sector.grid.cells);
    ASSERT_EQ(view.static_irradiance.size(), sector.static_irradiance.size());
    for (std::size_t p = 0; p < view.static_irradiance.size(); ++p) {
        EXPECT_EQ(view.static_irradiance[p], sector.static_irradiance[p].codes);
        EXPECT_EQ(view.static_exponents[p], sector.static_irradiance[p].exponent);
    }
}

void expect_equal_local(const SectorView& view, const LocalTransfer& local) {
    EXPECT_TRUE(std::equal(view.local_sources.begin(), view.local_sources.end(), local.sources.begin(),
                           local.sources.end()));
    EXPECT_TRUE(
        std::equal(view.local_pairs.begin(), view.local_pairs.end(), local.pairs.begin(), local.pairs.end()));
    ASSERT_EQ(view.local_receivers.size(), local.receivers.size());
    for (std::size_t p = 0; p < local.receivers.size(); ++p) {
        EXPECT_EQ(view.local_receivers[p].first_pair, local.receivers[p].first_pair);
        EXPECT_EQ(view.local_receivers[p].exponent, local.receivers[p].exponent);
        for (std::size_t k = 0; k < view.local_mask_bytes; ++k)
            EXPECT_EQ(view.local_masks[p * view.local_mask_bytes + k], local.receivers[p].sources[k]);
    }
}

void expect_equal_interiors(const SectorView& view, const std::vector<Interior>& interiors) {
    ASSERT_EQ(view.interiors.size(), interiors.size());
    for (std::size_t n = 0; n < interiors.size(); ++n) {
        const StoredInterior& stored = view.interiors[n];
        EXPECT_EQ(stored.origin_units, interiors[n].origin_units);
        EXPECT_EQ(stored.shift, interiors[n].shift);
        EXPECT_EQ(stored.probe, interiors[n].probe);
        const auto vertices = view.interior_vertices.subspan(stored.first_vertex, stored.vertex_count);
        const auto triangles = view.interior_triangles.subspan(stored.first_triangle, stored.triangle_count);
        EXPECT_TRUE(std::equal(vertices.begin(), vertices.end(), interiors[n].vertices.begin(),
                               interiors[n].vertices.end()));
        EXPECT_TRUE(std::equal(triangles.begin(), triangles.end(), interiors[n].triangles.begin(),
                               interiors[n].triangles.end()));
    }
}

void expect_equal_groups(const SectorView& view, const std::vector<LightGroup>& groups) {
    ASSERT_EQ(view.light_group_names.size(), groups.size());
    EXPECT_EQ(find_light_group(view, "no such group"), std::nullopt);
    for (std::size_t g = 0; g < groups.size(); ++g) {
        EXPECT_EQ(light_group_name(view, g), groups[g].name);
        EXPECT_EQ(find_light_group(view, groups[g].name), g);
        for (std::size_t p = 0; p < view.probe_count; ++p)
            EXPECT_EQ(light_group_irradiance_of(view, g, p), groups[g].irradiance[p]);
    }
}

TEST(SectorView, ShowsWhatAReaderReads) {
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
        const Sector sector =
            seed % 2 == 0 ? random_sector_1_2(seed, 1 + 23 * seed) : random_sector_1_3(seed, 1 + 23 * seed);
        const Bytes file = write_sector(sector);
        const SectorView view = open(file);
        expect_equal(view, sector);
        expect_equal_local(view, *sector.local_transfer);
        expect_equal_interiors(view, sector.interiors);
        expect_equal_groups(view, sector.light_groups);
    }
}

TEST(SectorView, OfAnEmptySectorIsEmpty) {
    const Bytes file = write_sector(random_sector(1, 0));
    const SectorView view = open(file);
    EXPECT_EQ(view.probe_count, 0u);
    EXPECT_TRUE(view.local_pairs.empty() && view.interiors.empty() && view.static_irradiance.empty());
}

TEST(SectorView, OpeningAllocatesNothing) {
    const Bytes file = write_sector(random_sector_1_2(3, 70));
    SectorView view;
    const std::size_t before = allocation_count();
    const ReadStatus status = open_sector(file, view);
    const std::size_t after = allocation_count();
    ASSERT_TRUE(status.ok());
    EXPECT_EQ(after, before);
    // The counter counts: a reader does allocate.
    Sector sector;
    ASSERT_TRUE(read_sector(file, sector).ok());
    EXPECT_GT(allocation_count(), after);
}

TEST(SectorView, RefusesWhatItCannotUseInPlace) {
    SectorView view;
    view.i = 77;
    const Bytes packed = write_sector(golden_sector_1_2(), {Codec::zstd});
    EXPECT_EQ(open_sector(packed, view).error, ReadError::compressed);
    Bytes shifted = golden_bytes_1_2();
    shifted.insert(shifted.begin(), 8, std::uint8_t{0});
    EXPECT_EQ(open_sector(std::span(shifted).subspan(8), view).error, ReadError::misaligned);
    const Bytes cut = Edit(golden_bytes_1_2()).cut(3000).as_is();
    EXPECT_EQ(open_sector(cut, view).error, ReadError::truncated);
    EXPECT_EQ(view.i, 77) << "left as it was";
}

TEST(SectorViewLookup, FindsProbesPositionsAndPairsAsAReaderDoes) {
    const Sector sector = random_sector_1_3(4, 40);
    const Bytes file = write_sector(sector);
    const SectorView view = open(file);
    const LocalTransfer& local = *sector.local_transfer;
    for (std::size_t p = 0; p < 40; ++p) {
        EXPECT_EQ(position_m(view, p), position_m(sector, sector.probes[p]));
        EXPECT_EQ(static_irradiance_of(view, p), sector.static_irradiance[p]);
        std::size_t pair = local.receivers[p].first_pair;
        for (std::size_t s = 0; s < local.sources.size(); ++s) {
            const LocalPair found = find_local_pair(view, p, s);
            ASSERT_EQ(found.codes != nullptr, has_pair(local.receivers[p], s));
            if (found.codes == nullptr)
                continue;
            EXPECT_EQ(*found.codes, local.pairs[pair++]);
            EXPECT_EQ(found.scale,
                      scale_of_exponent(local.receivers[p].exponent + local.sources[s].exponent));
        }
    }
}

TEST(SectorViewLookup, GridIsReadAsThePageSays) {
    Sector sector = golden_sector();  // (-1, 2), grid from 8 m, cells of 1 m
    for (std::size_t cell = 0; cell < grid_cell_count; ++cell)
        sector.grid.cells[cell] = static_cast<std::uint8_t>(cell % 2);
    sector.grid.cells[3 + 16 * 5 + 256 * 7] = 77;
    const Bytes file = write_sector(sector);
    const SectorView view = open(file);
    EXPECT_EQ(find_probe(view, {-64, 128, 8}), 0);
    EXPECT_EQ(find_probe(view, {-59.9f, 128, 8}), 1);
    EXPECT_EQ(find_probe(view, {-0.1f, 191, 23}), 1);
    EXPECT_EQ(find_probe(view, {-51, 149, 15.5f}), no_probe) << "names a probe that is not there";
    EXPECT_EQ(find_probe(view, {-1e9f, 128, -1e30f}), 0);
    EXPECT_EQ(find_probe(view, {1e9f, 1e30f, 1e9f}), 1);
    EXPECT_EQ(find_probe(view, {std::numeric_limits<float>::quiet_NaN(), 128, 8}), 0);
}

TEST(SectorViewLookup, InteriorsHoldWhatIsInside) {
    const Bytes file = golden_bytes_1_2();
    const SectorView view = open(file);
    // A box from (-20, 156, 9) to (-12, 164, 13) m, and one with a roof from (-24, 169, 10) to (-8, 185, 18)
    // m, its ridge at 18.94 m.
    EXPECT_EQ(find_interior(view, {-16, 160, 10}), &view.interiors[0]);
    EXPECT_EQ(find_interior(view, {-12.01f, 163.99f, 12.99f}), &view.interiors[0]);
    EXPECT_EQ(find_interior(view, {-11.99f, 160, 10}), nullptr);
    EXPECT_EQ(find_interior(view, {-16, 177, 18.9f}), &view.interiors[1]);
    EXPECT_EQ(find_interior(view, {-22, 171, 18.5f}), nullptr) << "beside the ridge";
    EXPECT_EQ(find_interior(view, {-16, 177, 9.9f}), nullptr);
    EXPECT_EQ(find_interior(view, {std::numeric_limits<float>::quiet_NaN(), 177, 12}), nullptr);
}

TEST(UnpackSector, GivesTheRawFile) {
    for (const Sector& sector : {golden_sector(), golden_sector_1_1(), golden_sector_1_2(),
                                 random_sector_1_2(9, 70), random_sector_1_3(5, 9), random_sector(2, 0)}) {
        Bytes raw = {1, 2, 3};
        ASSERT_TRUE(unpack_sector(write_sector(sector, {Codec::zstd}), raw).ok());
        EXPECT_EQ(raw, write_sector(sector));
    }
    Bytes untouched = {1, 2, 3};
    EXPECT_FALSE(unpack_sector(Bytes{1, 2}, untouched).ok());
    EXPECT_EQ(untouched, (Bytes{1, 2, 3}));
}

}  // namespace
}  // namespace drtv::test
