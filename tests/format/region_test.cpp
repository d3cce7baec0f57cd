// Sectors beside each other: a broken region for each issue of the groups borders and set, with the whole
// report that it must give.
#include "tests/format/sector_bytes.h"
#include "tests/format/sectors.h"

#include <drtv/validate_region.h>
#include <drtv/write.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>

namespace drtv::test {
namespace {

// A sector of the plain: 4 x 4 probes 16 m apart on a floor of albedo 1/2, each a little brighter than the
// one to its west.
Sector plain(std::int32_t i, std::int32_t j) {
    Sector sector = golden_sector();
    const Probe floor = sector.probes[0];
    sector.i = i;
    sector.j = j;
    sector.probes.clear();
    for (std::uint16_t y = 0; y < 4; ++y) {
        for (std::uint16_t x = 0; x < 4; ++x) {
            Probe probe = floor;
            probe.position = {static_cast<std::uint16_t>(8192 + 16384 * x),
                              static_cast<std::uint16_t>(8192 + 16384 * y), 1024};
            for (auto& channel : probe.transfer)
                channel[3][0] = static_cast<std::int16_t>(channel[3][0] + 250 * x);
            sector.probes.push_back(probe);
        }
    }
    fill_grid(sector, [](std::size_t) { return std::size_t{0}; });
    return sector;
}

using Change = std::function<void(std::vector<Sector>&)>;

std::vector<Sector> square(std::int32_t side) {
    std::vector<Sector> sectors;
    for (std::int32_t j = 0; j < side; ++j) {
        for (std::int32_t i = 0; i < side; ++i)
            sectors.push_back(plain(i, j));
    }
    return sectors;
}

LocalTransfer light_from(std::int8_t di, std::uint8_t probe) {
    LocalTransfer local;
    local.sources = {{0, 0, 0, 0}, {di, 0, probe, 0}};
    local.receivers.resize(16);
    return local;
}

std::string report_of(const std::vector<Sector>& sectors, bool name_them = false) {
    std::vector<RegionSector> region(sectors.size());
    for (std::size_t n = 0; n < sectors.size(); ++n) {
        if (name_them)
            region[n].named = {{static_cast<std::int32_t>(n % 3), static_cast<std::int32_t>(n / 3)}};
        const ReadStatus status = read_region_sector(write_sector(sectors[n]), region[n]);
        EXPECT_TRUE(status.ok()) << status.message;
    }
    std::string report;
    for (const auto& [sector, finding] : validate_region(region)) {
        if (!report.empty())
            report += '\n';
        report += std::to_string(sector) + ": " + std::string(finding.issue->code) + " at " +
                  std::to_string(finding.offset) + ", " + finding.path + ": " + finding.message;
    }
    return report;
}

struct Case {
    const char* name;
    Change change;  // of 3 x 3 sectors of the plain
    std::string report;
};

const std::vector<Case> cases = {
    {"SectorTwice", [](auto& s) { s.push_back(plain(1, 1)); },
     "9: SET_DUPLICATE at 16, : sector (1, 1) is in another file of the set too"},
    {"OtherSettings", [](auto& s) { s[4].bake.settings_key[0] = 9; },
     "4: SET_SETTINGS at 0, settings.key: was baked with other settings than 8 of the 9 sectors"},
    {"Hole", [](auto& s) { s.erase(s.begin() + 4); },
     "3: SET_HOLE at 16, : sector (1, 1) to its east is missing, and sectors are all around"},
    {"SourceThatIsNotThere",
     [](auto& s) {
         for (Sector& sector : s)
             sector.local_transfer = light_from(0, 1);
         s[0].local_transfer = light_from(1, 16);
     },
     "0: NEIGHBOUR_SOURCE at 6308, local_transfer.sources[1]: is probe 16 of sector (1, 0), which has 16"},
    {"LocalTransferOnOneSide",
     [](auto& s) {
         for (std::size_t n = 0; n < 8; ++n)
             s[n].local_transfer = light_from(0, 1);
     },
     "8: NEIGHBOUR_SECTIONS at 0, : has no local transfer, and its neighbour (1, 2) has\n8: "
     "NEIGHBOUR_SECTIONS at 0, : has no local transfer, and its neighbour (2, 1) has"},
    {"DarkSector",
     [](auto& s) {
         for (Probe& probe : s[0].probes)
             probe.sky_visibility = {3277, 3277, 3277, 0};
     },
     "0: NEIGHBOUR_STEP at 0, : towards sector (1, 0) light steps by 0.615040 on average more than heights "
     "and sky tell, inside the two by "
     "0.006762\n"
     "0: NEIGHBOUR_STEP at 0, : towards sector (0, 1) light steps by 0.614705 on average more than heights "
     "and sky tell, inside the two by "
     "0.000000"},
};

class RegionValidator : public testing::TestWithParam<Case> {};

TEST_P(RegionValidator, IsReported) {
    std::vector<Sector> sectors = square(3);
    GetParam().change(sectors);
    EXPECT_EQ(report_of(sectors), GetParam().report);
}

INSTANTIATE_TEST_SUITE_P(, RegionValidator, testing::ValuesIn(cases),
                         [](const auto& c) { return c.param.name; });

TEST(RegionIssues, EachHasACase) {
    for (const Issue* issue : all_issues()) {
        if (issue->group != IssueGroup::borders && issue->group != IssueGroup::set)
            continue;
        if (issue == &issue::set_file_name)
            continue;  // FileNames below
        const std::string code = ": " + std::string(issue->code) + " at ";
        EXPECT_TRUE(std::ranges::any_of(cases, [&](const Case& c) {
            return c.report.find(code) != std::string::npos;
        })) << issue->code;
    }
}

TEST(Region, ThatFitsGivesNoFinding) {
    EXPECT_EQ(report_of(square(3)), "");
}

TEST(Region, OfNothingGivesNoFinding) {
    EXPECT_TRUE(validate_region({}).empty());
}

TEST(Region, FileNamesMustTellTheirSector) {
    EXPECT_EQ(report_of(square(3), true), "");
    std::vector<Sector> sectors = square(3);
    std::swap(sectors[0], sectors[8]);
    EXPECT_EQ(report_of(sectors, true),
              "0: SET_FILE_NAME at 16, : the file is named for sector (0, 0) and holds sector (2, 2)\n"
              "8: SET_FILE_NAME at 16, : the file is named for sector (2, 2) and holds sector (0, 0)");
}

TEST(Region, BaysAreNoHoles) {
    std::vector<Sector> sectors = square(3);
    sectors.erase(sectors.begin() + 7);  // in the middle of the northern side
    EXPECT_EQ(report_of(sectors), "");
    sectors.erase(sectors.begin() + 4);  // and behind it
    EXPECT_EQ(report_of(sectors), "");
}

TEST(Region, UnreadableSectorIsNoHole) {
    std::vector<Sector> sectors = square(3);
    sectors.erase(sectors.begin() + 4);
    std::vector<RegionSector> region(sectors.size());
    for (std::size_t n = 0; n < sectors.size(); ++n)
        ASSERT_TRUE(read_region_sector(write_sector(sectors[n]), region[n]).ok());
    EXPECT_EQ(validate_region(region).size(), 1u);
    const std::array<std::array<std::int32_t, 2>, 1> unreadable = {{{1, 1}}};
    EXPECT_TRUE(validate_region(region, unreadable).empty());
}

TEST(Region, HoleOfTwoIsOneFinding) {
    std::vector<Sector> sectors = square(4);
    std::erase_if(sectors, [](const Sector& s) { return s.j == 1 && (s.i == 1 || s.i == 2); });
    EXPECT_EQ(report_of(sectors),
              "4: SET_HOLE at 16, : sector (1, 1) to its east is missing with 1 more beside it, and sectors "
              "are all around");
}

// Sectors may lie anywhere, as far apart as coordinates go; what lies between them is not walked.
TEST(Region, FarApartSectorsAreNoHoles) {
    EXPECT_EQ(report_of({plain(-16384, -16384), plain(16384, 16384), plain(-16384, 16384),
                         plain(16384, -16384), plain(0, 0)}),
              "");
}

TEST(Region, HolesInScatteredIslandsAreFoundAtOnce) {
    // 100 rings of 8 sectors, far apart and without an order, each around a hole; one of them in the lake of
    // a larger ring.
    std::vector<RegionSector> region;
    const RegionSector one = [] {
        RegionSector sector;
        EXPECT_TRUE(read_region_sector(write_sector(random_sector(1, 0)), sector).ok());
        return sector;
    }();
    const auto put = [&](std::int32_t i, std::int32_t j) {
        region.push_back(one);
        region.back().i = i;
        region.back().j = j;
    };
    const auto put_ring = [&](std::int32_t i, std::int32_t j, std::int32_t radius) {
        for (std::int32_t y = -radius; y <= radius; ++y) {
            for (std::int32_t x = -radius; x <= radius; ++x) {
                if (std::max(std::abs(x), std::abs(y)) == radius)
                    put(i + x, j + y);
            }
        }
    };
    for (std::int32_t n = 0; n < 100; ++n)
        put_ring(n * 7919 % 16000, n * 104729 % 16000, 1);
    put_ring(-5000, -5000, 1);
    put_ring(-5000, -5000, 4);
    std::size_t holes = 0, missing = 0;
    for (const RegionFinding& found : validate_region(region)) {
        EXPECT_EQ(found.finding.issue, &issue::set_hole);
        ++holes;
        missing += static_cast<std::size_t>(found.finding.value.value_or(0));
    }
    EXPECT_EQ(holes, 102u);
    EXPECT_EQ(missing, 100 + 1 + (7 * 7 - 3 * 3u));
}

// Probes of both sides of the border between sectors 0 and 1 see a part of the sky.
void hide_sky(std::vector<Sector>& sectors, const std::array<std::int16_t, 4>& from_west,
              const std::array<std::int16_t, 4>& from_east) {
    for (Probe& probe : sectors[0].probes)
        probe.sky_visibility = from_west;
    for (Probe& probe : sectors[1].probes)
        probe.sky_visibility = from_east;
}

// Basis 2 looks east, 0 and 1 look west.
TEST(Region, RidgeOnTheBorderIsNoStep) {
    std::vector<Sector> sectors = square(2);
    sectors.erase(sectors.begin() + 2, sectors.end());
    hide_sky(sectors, {32767, 32767, 9000, 0}, {9000, 9000, 32767, 0});
    EXPECT_EQ(report_of(sectors), "");
    // Its other side is open towards what should be a ridge.
    hide_sky(sectors, {32767, 32767, 9000, 0}, {32767, 32767, 32767, 0});
    EXPECT_NE(report_of(sectors), "");
}

TEST(Region, CliffOnTheBorderIsNoStepAsFarAsItsHeightGoes) {
    for (const auto& [height_m, explains] : {std::pair(40, true), {2, false}}) {
        std::vector<Sector> sectors = square(2);
        sectors.erase(sectors.begin() + 2, sectors.end());
        hide_sky(sectors, {32767, 32767, 6000, 0}, {32767, 32767, 32767, 0});
        sectors[1].z_origin_units += height_m * 1024;
        EXPECT_EQ(report_of(sectors).empty(), explains) << height_m << " m";
    }
}

}  // namespace
}  // namespace drtv::test
