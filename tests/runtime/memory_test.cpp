// Memory, as the talk counts it (slide 24): 51 sectors of 70 probes.
#include "tests/format/sectors.h"

#include <drtv/relit_probes.h>
#include <drtv/write.h>

#include <gtest/gtest.h>

#include <vector>

namespace drtv {
namespace {

constexpr std::size_t sector_count = 51;
constexpr std::size_t probe_count = 70;
constexpr std::size_t kilobyte = 1024;

// That the probes of one sector take light from, where 70 stand in each: as many as random places gave.
constexpr std::size_t max_sources = 353;

// All that a sector of the talk has: with local transfer, each probe from its 128 nearest of nine sectors.
Sector sector_of_the_talk(bool with_local) {
    Sector sector = test::random_sector(3, probe_count);
    if (!with_local)
        return sector;
    LocalTransfer local;
    for (std::int8_t dj = -1; dj <= 1; ++dj) {
        for (std::int8_t di = -1; di <= 1; ++di) {
            for (std::size_t p = 0; p < probe_count; ++p)
                if (local.sources.size() < max_sources)
                    local.sources.push_back({di, dj, static_cast<std::uint8_t>(p), 0});
        }
    }
    local.receivers.resize(probe_count);
    std::vector<std::size_t> nearest(max_local_sources);
    for (std::size_t n = 0; n < nearest.size(); ++n)
        nearest[n] = n * 2;
    for (std::size_t p = 0; p < probe_count; ++p)
        test::add_pairs(local, p, nearest, LightCodes{{{100, 0, 0, 0}, {100, 0, 0, 0}, {100, 0, 0, 0}}});
    sector.local_transfer = local;
    return sector;
}

TEST(Memory, FilesInMemoryAreAsLargeAsTheTalks) {
    EXPECT_LE(sector_count * write_sector(sector_of_the_talk(false)).size(), 765 * kilobyte);
    // Where each probe has all of its 128 pairs, and none rounds to nothing: 1 % more than the talk's.
    // Sources are of nine sectors here, and need a longer list and masks.
    EXPECT_LE(sector_count * write_sector(sector_of_the_talk(true)).size(), 11475 * kilobyte * 102 / 100);
}

TEST(Memory, OutputIs24BytesPerProbeAnd48WhileAFadeRuns) {
    constexpr std::size_t probes = sector_count * probe_count;
    const SectorSetLimits limits{.sectors = sector_count, .probes = probes, .interiors = 0, .tiles = 64};
    constexpr std::size_t per_sector = 64;  // stamps
    EXPECT_LE(RelitProbes::memory_bytes(limits, false), 24 * probes + per_sector * sector_count);
    EXPECT_LE(RelitProbes::memory_bytes(limits, true), 48 * probes + per_sector * sector_count);
    EXPECT_LE(SectorSet::memory_bytes(limits), 700 * sector_count + 820 * limits.tiles + kilobyte);
}

}  // namespace
}  // namespace drtv
