// A broken file for each issue code, with the whole report that it must give.
#include "tests/format/sector_bytes.h"
#include "tests/format/sectors.h"

#include <drtv/validate.h>
#include <drtv/write.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

namespace drtv::test {
namespace {

struct Case {
    const char* name;
    std::function<Bytes()> file;
    std::string report;  // CODE at byte, path: message
};

Bytes changed(Sector sector, const std::function<void(Sector&)>& change, Codec codec = Codec::raw) {
    change(sector);
    return write_sector(sector, {codec});
}

Bytes golden_with(const std::function<void(Sector&)>& change, Codec codec = Codec::raw) {
    return changed(golden_sector(), change, codec);
}

// The optional sections stand at 4912, 4992 and 5232 there: three probes, three local sources, five pairs.
Bytes golden_1_1_with(const std::function<void(Sector&)>& change) {
    return changed(golden_sector_1_1(), change);
}

Bytes with_sources_of_one_probe(std::size_t count) {
    return golden_1_1_with([&](Sector& s) {
        LocalTransfer& local = s.local_transfer.emplace();
        local.sources = neighbouring_sources(count);
        local.receivers.resize(s.probes.size());
        for (std::size_t source = 0; source < count; ++source)
            add_pairs(local, 1, {source}, {});
    });
}

Bytes golden_1_2_with(const std::function<void(Sector&)>& change) {
    return changed(golden_sector_1_2(), change);
}

Bytes golden_1_3_with(const std::function<void(Sector&)>& change) {
    return changed(golden_sector_1_3(), change);
}

// Seven probes, each a source for all others; towards a probe of a smaller index five times as much light as
// back.
Bytes one_way_light() {
    return golden_with([](Sector& s) {
        s.probes.resize(7, s.probes[0]);
        LocalTransfer& local = s.local_transfer.emplace();
        local.receivers.resize(s.probes.size());
        for (std::size_t p = 0; p < s.probes.size(); ++p) {
            s.probes[p].position = {static_cast<std::uint16_t>(9000 * p), 2048, 0};
            local.sources.push_back({0, 0, static_cast<std::uint8_t>(p), 0});
        }
        for (std::size_t p = 0; p < s.probes.size(); ++p) {
            for (std::size_t q = 0; q < s.probes.size(); ++q) {
                const auto light = static_cast<std::int16_t>(q > p ? 5000 : 1000);
                if (p != q)
                    add_pairs(local, p, {q}, {{{light, 0, 0, 0}, {light, 0, 0, 0}, {light, 0, 0, 0}}});
            }
        }
        fill_grid(s, [](std::size_t) { return std::size_t{0}; });
    });
}

std::string report_of(const Bytes& file) {
    std::string report;
    for (const Finding& finding : validate_sector(file).findings) {
        if (!report.empty())
            report += '\n';
        report += std::string(finding.issue->code) + " at " + std::to_string(finding.offset) + ", " +
                  finding.path + ": " + finding.message;
    }
    return report;
}

const std::vector<Case> cases = {
    {"Cut", [] { return Edit(golden_bytes()).cut(4000).as_is(); },
     "TRUNCATED at 4000, : the header says 4680 bytes, the file has 4000"},
    {"Text",
     [] {
         return Bytes{'h', 'e', 'l', 'l', 'o'};
     },
     "NOT_A_SECTOR_FILE at 0, : not a drtv sector file: it does not start with \"DRTV\""},
    {"OneByteMore", [] { return Edit(golden_bytes()).append(0).as_is(); },
     "TRAILING_BYTES at 4680, : the header says 4680 bytes, the file has 4681"},
    {"TooManyProbes", [] { return Edit(golden_bytes()).u16(at::probe_count, 256).sealed(); },
     "HEADER at 28, : probe count 256 is over the limit of 255"},
    {"SectionElsewhere", [] { return Edit(golden_bytes()).u32(entry(1) + at::offset, 320).sealed(); },
     "TABLE at 96, : positions section (kind 2) starts at 320, must start at 304"},
    {"NoGrid", [] { return without(golden_bytes(), 5); },
     "MISSING_SECTION at 0, : the grid section is missing"},
    {"UnknownKindOfProbe", [] { return Edit(golden_bytes()).u8(310, 3).sealed(); },
     "SECTION at 310, : probe 0: kind 3 is unknown"},
    {"UnknownSection",
     [] {
         return with_one_more(golden_bytes(), {77, 5, 9, 3, {1, 2, 3}});
     },
     "UNKNOWN_SECTION at 4720, : unknown section (kind 77) of version 5 is none that a file of this version "
     "has, and was skipped"},
    {"LightSectionInAFileOf10", [] { return Edit(golden_bytes_1_1()).u16(at::minor, 0).sealed(); },
     "UNKNOWN_SECTION at 4912, : static irradiance section (kind 7) of version 1 is none that a file of this "
     "version has, and was skipped\n"
     "UNKNOWN_SECTION at 4992, : local transfer section (kind 8) of version 1 is none that a file of this "
     "version has, and was skipped\n"
     "UNKNOWN_SECTION at 5232, : convergence section (kind 9) of version 1 is none that a file of this "
     "version has, and was skipped"},
    {"ChangedByte", [] { return Edit(golden_bytes()).u8(340, 1).as_is(); },
     "CHECKSUM at 336, : transfer section (kind 4): its checksum does not match its bytes"},
    {"OtherMajor", [] { return Edit(golden_bytes()).u16(at::major, 2).sealed(); },
     "UNSUPPORTED_VERSION at 4, : format version 2.0 is not supported: this reader knows version 1"},
    {"OtherSectionVersion", [] { return Edit(golden_bytes()).u16(entry(4) + at::version, 2).sealed(); },
     "UNSUPPORTED_VERSION at 528, : grid section (kind 5) has version 2, this reader knows 1"},
    {"ReservedCodeInTransfer",
     [] { return golden_with([](Sector& s) { s.probes[1].transfer[2][3][1] = INT16_MIN; }); },
     "FIXED_POINT_RESERVED at 522, probe[1].transfer.b[3][1]: code -32768 is reserved"},
    {"ReservedCodeInSkyVisibility",
     [] { return golden_with([](Sector& s) { s.probes[1].sky_visibility[2] = INT16_MIN; }); },
     "FIXED_POINT_RESERVED at 332, probe[1].sky_visibility[2]: code -32768 is reserved"},
    {"NegativeSkyVisibility",
     [] { return golden_with([](Sector& s) { s.probes[0].sky_visibility[1] = -1; }); },
     "SKY_VISIBILITY_RANGE at 322, probe[0].sky_visibility[1]: code -1 is negative"},
    {"SkyBelow", [] { return golden_with([](Sector& s) { s.probes[1].sky_visibility[3] = 1; }); },
     "SKY_VISIBILITY_DOWN at 334, probe[1].sky_visibility[3]: code 1, must be 0"},
    {"TransferOverY0", [] { return golden_with([](Sector& s) { s.probes[0].transfer[0][0][0] = 18488; }); },
     "TRANSFER_RANGE at 336, probe[0].transfer.r[0][0]: 0.282113 is beyond 0.282100"},
    {"TransferUnderY1", [] { return golden_with([](Sector& s) { s.probes[0].transfer[1][2][3] = -32027; }); },
     "TRANSFER_RANGE at 390, probe[0].transfer.g[2][3]: -0.488708 is beyond 0.488700"},
    {"NegativeTransferOfY0",
     [] { return golden_with([](Sector& s) {
              s.probes[1].transfer[0][0] = {-1, 0, 0, 0};
          }); },
     "TRANSFER_SIGN at 432, probe[1].transfer.r[0][0]: -0.000015 is negative"},
    {"NegativeTransferOfY2",
     [] { return golden_with([](Sector& s) { s.probes[1].transfer[2][3][2] = -40; }); },
     "TRANSFER_SIGN at 524, probe[1].transfer.b[3][2]: -0.000610 is negative"},
    {"MoreOfBand1ThanOfBand0",
     [] { return golden_with([](Sector& s) {
              s.probes[1].transfer[1][2] = {1000, 0, 0, -1735};
          }); },
     "TRANSFER_BAND at 486, probe[1].transfer.g[2][3]: -0.026475 is more than sqrt(3) times 0.015259 of Y0"},
    {"MoreLightThanTheSkyHas",
     [] { return golden_with([](Sector& s) {
              s.probes[0].transfer[1][0] = {4200, 0, 0, 0};
          }); },
     "ENERGY at 368, probe[0].transfer.g[0][0]: bounce 0.227189 and sky 0.788675 under a sky of radiance 1 "
     "add up to more than 1"},
    {"InteriorWithoutATriangle",
     [] { return golden_1_2_with([](Sector& s) { s.interiors[0].triangles.pop_back(); }); },
     "INTERIOR_OPEN at 5328, interior[0]: has more triangles on one side of an edge at vertex 1 than on the "
     "other"},
    {"InteriorTurnedInwards",
     [] {
         return golden_1_2_with([](Sector& s) {
             for (auto& triangle : s.interiors[1].triangles)
                 std::swap(triangle[0], triangle[1]);
         });
     },
     "INTERIOR_INSIDE_OUT at 5360, interior[1]: its triangles enclose no volume, or face inwards"},
    {"InteriorAwayFromItsProbe",
     [] { return golden_1_2_with([](Sector& s) { s.interiors[0].origin_units[2] += 1025; }); },
     "INTERIOR_PROBE at 5341, interior[0]: its probe 1 stands outside of its bounds"},
    {"StaticIrradianceAtItsLimit",
     [] {
         return golden_1_1_with([](Sector& s) {
             s.static_irradiance[1].exponent = 64;
             s.static_irradiance[1].codes[1][2] = 32767;
         });
     },
     "FIXED_POINT_SATURATED at 4948, probe[1].static_irradiance.g[2]: code 32767 under the largest exponent"},
    {"ThereOtherThanBack", one_way_light,
     "LOCAL_RECIPROCITY at 5296, local_transfer: there and back, 21 pairs of probes differ by 0.666667 of "
     "their sum, more than 0.6"},
    {"GridNamesNoSuchProbe", [] { return golden_with([](Sector& s) { s.grid.cells[4095] = 2; }); },
     "GRID_REFERENCE at 4639, grid.cells[4095]: names probe 2, the sector has 2"},
    {"GridOfEmptySectorNamesAProbe",
     [] {
         return golden_with([](Sector& s) {
             s.probes.clear();
             s.grid.cells.fill(no_probe);
             s.grid.cells[1] = 0;
         });
     },
     "GRID_REFERENCE at 321, grid.cells[1]: names probe 0, the sector has 0"},
    {"GridCellEmpty", [] { return golden_with([](Sector& s) { s.grid.cells[0] = no_probe; }); },
     "GRID_NO_PROBE at 544, grid.cells[0]: names no probe, the sector has 2 that no interior names"},
    {"NoRays", [] { return golden_with([](Sector& s) { s.bake.rays = 0; }); },
     "SETTINGS_RANGE at 256, settings.rays: is not above 0"},
    {"NoReach", [] { return golden_with([](Sector& s) { s.bake.reach_m = 0; }); },
     "SETTINGS_RANGE at 264, settings.reach: is not above 0"},
    {"NegativeDistance", [] { return golden_with([](Sector& s) { s.bake.min_distance_m = -1; }); },
     "SETTINGS_RANGE at 268, settings.min_distance: is not above 0"},
    {"TwoProbesAtOnePlace",
     [] { return golden_with([](Sector& s) { s.probes[1].position = s.probes[0].position; }); },
     "DUPLICATE_POSITION at 312, probe[1].position: is that of probe 0"},
    {"ThreeProbesAtOnePlace",
     [] {
         return golden_with([](Sector& s) {
             s.probes[1].position = s.probes[0].position;
             s.probes.push_back(s.probes[0]);
         });
     },
     "DUPLICATE_POSITION at 312, probe[1].position: is that of probe 0\nDUPLICATE_POSITION at 320, "
     "probe[2].position: is that of probe 0"},
    {"SeveralInTheOrderOfTheFile",
     [] {
         return golden_with([](Sector& s) {
             s.grid.cells[7] = 9;
             s.bake.rays = 0;
             s.probes[0].transfer[0][0][1] = INT16_MIN;
         });
     },
     "SETTINGS_RANGE at 256, settings.rays: is not above 0\nFIXED_POINT_RESERVED at 338, "
     "probe[0].transfer.r[0][1]: code -32768 is reserved\n"
     "GRID_REFERENCE at 551, grid.cells[7]: names probe 9, the sector has 2"},
    {"ReservedCodeInStaticIrradiance",
     [] { return golden_1_1_with([](Sector& s) { s.static_irradiance[2].codes[1][0] = INT16_MIN; }); },
     "FIXED_POINT_RESERVED at 4968, probe[2].static_irradiance.g[0]: code -32768 is reserved"},
    {"NegativeStaticIrradiance",
     [] { return golden_1_1_with([](Sector& s) { s.static_irradiance[0].codes[2][3] = -1; }); },
     "STATIC_IRRADIANCE_RANGE at 4934, probe[0].static_irradiance.b[3]: code -1 is negative"},
    {"StaticExponentTooSmall",
     [] { return golden_1_1_with([](Sector& s) { s.static_irradiance[1].exponent = -65; }); },
     "STATIC_EXPONENT at 4985, probe[1].static_irradiance.exponent: -65 is not between -64 and 64"},
    {"StaticExponentTooLarge",
     [] { return golden_1_1_with([](Sector& s) { s.static_irradiance[2].exponent = 65; }); },
     "STATIC_EXPONENT at 4986, probe[2].static_irradiance.exponent: 65 is not between -64 and 64"},
    {"TooManySourcesOfOneProbe", [] { return with_sources_of_one_probe(129); },
     "LOCAL_SOURCE_COUNT at 5600, probe[1].local: takes light from 129 sources, over the limit of 128"},
    {"SourceTwice", [] { return golden_1_1_with([](Sector& s) { s.local_transfer->sources[1].probe = 0; }); },
     "LOCAL_SOURCE_DUPLICATE at 5012, local_transfer.sources[1]: is that of source 0"},
    {"ReservedCodeInLocalTransfer",
     [] { return golden_1_1_with([](Sector& s) { s.local_transfer->pairs[3][1][0] = INT16_MIN; }); },
     "FIXED_POINT_RESERVED at 5184, probe[1].local[2].g[0]: code -32768 is reserved"},
    {"LocalExponentTooSmall",
     [] { return golden_1_1_with([](Sector& s) { s.local_transfer->receivers[2].exponent = -124; }); },
     "LOCAL_EXPONENT at 5044, probe[2].local[0]: exponents -124 and -3 add up to -127, not between -126 and "
     "63"},
    {"LocalExponentTooLarge",
     [] { return golden_1_1_with([](Sector& s) { s.local_transfer->receivers[0].exponent = 64; }); },
     "LOCAL_EXPONENT at 5028, probe[0].local[0]: exponents 64 and 0 add up to 64, not between -126 and 63"},
    {"LocalTransferNegative",
     [] { return golden_1_1_with([](Sector& s) {
              s.local_transfer->pairs[0][0] = {-1, 0, 0, 0};
          }); },
     "LOCAL_TRANSFER_RANGE at 5104, probe[0].local[0].r[0]: code -1 is negative"},
    {"LocalTransferOverBand0",
     [] { return golden_1_1_with([](Sector& s) {
              s.local_transfer->pairs[4][2] = {10000, 0, 0, -11550};
          }); },
     "LOCAL_TRANSFER_RANGE at 5222, probe[2].local[0].b[3]: code -11550 is beyond 1.1548 times code 10000 of "
     "band 0"},
    {"NegativeErrorAsked", [] { return golden_1_1_with([](Sector& s) { s.convergence->error_asked = -1; }); },
     "CONVERGENCE_RANGE at 5232, convergence.error_asked: -1.000000 is less than 0"},
    {"NegativeMedian", [] { return golden_1_1_with([](Sector& s) { s.convergence->error_median = -1; }); },
     "CONVERGENCE_RANGE at 5236, convergence.error_median: -1.000000 is less than 0"},
    {"ErrorsOutOfOrder",
     [] { return golden_1_1_with([](Sector& s) { s.convergence = {0, 3, 2, 1, 0, 0, 0, 0, 0, 0}; }); },
     "CONVERGENCE_RANGE at 5240, convergence.error_p95: 2.000000 is less than the median\n"
     "CONVERGENCE_RANGE at 5244, convergence.error_max: 1.000000 is less than the 95th percentile"},
    {"LightGroupsOutOfOrder",
     [] { return golden_1_3_with([](Sector& s) { s.light_groups[1].name = "lantern"; }); },
     "LIGHT_GROUP_NAME at 6976, light_groups[1]: does not stand behind that of light group 0 in order"},
    {"LightGroupNameIsNoText",
     [] { return golden_1_3_with([](Sector& s) { s.light_groups[1].name = "n\xED\xA0\x80"; }); },
     "LIGHT_GROUP_NAME at 6976, light_groups[1]: is no UTF-8"},
    {"LightGroupNegative",
     [] { return golden_1_3_with([](Sector& s) { s.light_groups[1].irradiance[1].codes[2][3] = -5; }); },
     "STATIC_IRRADIANCE_RANGE at 7158, probe[1].light_groups[1].b[3]: code -5 is negative"},
    {"LightGroupExponent",
     [] { return golden_1_3_with([](Sector& s) { s.light_groups[0].irradiance[2].exponent = 65; }); },
     "STATIC_EXPONENT at 7186, probe[2].light_groups[0].exponent: 65 is not between -64 and 64"},
    {"QualityErrorNegative",
     [] { return golden_1_3_with([](Sector& s) { s.quality->probes[1].static_error = -0.5f; }); },
     "CONVERGENCE_RANGE at 7248, probe[1].quality.static_error: -0.500000 is less than 0"},
    {"QualityGroupErrorNegative",
     [] { return golden_1_3_with([](Sector& s) { s.quality->group_errors[1][0] = -2; }); },
     "CONVERGENCE_RANGE at 7300, probe[0].quality.group_errors[1]: -2.000000 is less than 0"},
    {"MostPathsFewerThanLeast",
     [] { return golden_1_1_with([](Sector& s) { s.convergence->paths_most = 255; }); },
     "CONVERGENCE_RANGE at 5252, convergence.paths_most: 255 is less than the least"},
};

class SectorValidator : public testing::TestWithParam<Case> {};

TEST_P(SectorValidator, IsReported) {
    EXPECT_EQ(report_of(GetParam().file()), GetParam().report);
}

INSTANTIATE_TEST_SUITE_P(, SectorValidator, testing::ValuesIn(cases),
                         [](const auto& c) { return c.param.name; });

// Those of regions have theirs in region_test.cpp.
TEST(ValidatorIssues, EachHasACase) {
    for (const Issue* issue : all_issues()) {
        if (issue->group == IssueGroup::borders || issue->group == IssueGroup::set)
            continue;
        const std::string start = std::string(issue->code) + " at ";
        EXPECT_TRUE(std::any_of(cases.begin(), cases.end(), [&](const Case& c) {
            return c.report.starts_with(start);
        })) << issue->code;
    }
}

TEST(ValidatorIssues, CodesAreUniqueAndExplained) {
    std::set<std::string_view> codes;
    for (const Issue* issue : all_issues()) {
        EXPECT_TRUE(codes.insert(issue->code).second) << issue->code;
        EXPECT_FALSE(issue->meaning.empty());
        EXPECT_EQ(issue_of_code(issue->code), issue);
    }
    for (const std::string_view retired : {"STRUCTURE", "GRID_NOT_NEAREST", "NEIGHBOUR_DISTANCE"}) {
        EXPECT_FALSE(codes.contains(retired)) << "never to be used again";
        EXPECT_EQ(issue_of_code(retired), nullptr);
    }
}

TEST(Validator, CellsMayBeEmptyWhereInteriorsNameAllProbes) {
    const auto emptied = [](bool all_named) {
        return golden_1_2_with([&](Sector& s) {
            s.grid.cells.fill(no_probe);
            Interior interior = s.interiors[0];
            s.interiors.clear();
            for (std::size_t p = 0; p < s.probes.size(); ++p) {
                interior.probe = static_cast<std::uint8_t>(p);
                if (p > 0 || all_named)
                    s.interiors.push_back(interior);
            }
        });
    };
    const auto reports_empty_cells = [](const Bytes& file) {
        return std::ranges::any_of(validate_sector(file).findings,
                                   [](const Finding& f) { return f.issue == &issue::grid_no_probe; });
    };
    EXPECT_FALSE(reports_empty_cells(emptied(true)));
    EXPECT_TRUE(reports_empty_cells(emptied(false)));
}

TEST(Validator, FindingInAPackedSectionPointsAtItsFirstByte) {
    const Bytes file = golden_with([](Sector& s) { s.grid.cells[4000] = 7; }, Codec::zstd);
    const auto findings = validate_sector(file).findings;
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].offset, section_start(file, 5));
}

TEST(Validator, StopsAtTheNumberOfFindingsAskedFor) {
    const Bytes file = golden_with([](Sector& s) { s.grid.cells.fill(no_probe); });
    for (const auto& [asked, shown] : {std::pair(3u, 3u), {100u, 100u}, {10'000u, 4096u}}) {
        const Report report = validate_sector(file, {.max_findings = asked});
        EXPECT_EQ(report.findings.size(), shown);
        EXPECT_EQ(report.truncated, shown < 4096);
        EXPECT_EQ(report.errors, 4096u) << "those behind the cap count too";
    }
}

TEST(Validator, EndsOfTheOptionalRangesAreAllowed) {
    EXPECT_EQ(report_of(golden_bytes_1_1()), "");  // the smallest exponents, and the largest band 1
    EXPECT_EQ(report_of(with_sources_of_one_probe(128)), "");
    EXPECT_EQ(report_of(golden_1_1_with([](Sector& s) {
                  s.static_irradiance[0].exponent = 64;
                  s.static_irradiance[0].codes[0][3] = 32766;
                  s.local_transfer->receivers[0].exponent = 63;
                  s.convergence = Convergence{};
              })),
              "");
}

TEST(Validator, LargestPassiveTransferIsAllowed) {
    EXPECT_EQ(report_of(golden_with([](Sector& s) {
                  s.probes[0].sky_visibility = {};
                  s.probes[0].transfer[0][0] = {18487, 32022, 32022, -32022};
                  s.probes[0].transfer[0][1] = {0, 2, 0, -2};
              })),
              "");
}

TEST(Validator, QuickLooksAtTheStructureOnly) {
    EXPECT_TRUE(validate_sector(golden_with([](Sector& s) { s.grid.cells[0] = 9; }), {.quick = true})
                    .findings.empty());
    EXPECT_EQ(validate_sector(Edit(golden_bytes()).u8(340, 1).as_is(), {.quick = true}).errors, 1u);
}

TEST(Validator, IgnoredIssueIsNeitherShownNorCounted) {
    const Bytes file = golden_with([](Sector& s) {
        s.grid.cells[0] = 9;
        s.bake.rays = 0;
    });
    const std::array<const Issue*, 1> ignored = {&issue::grid_reference};
    const Report report = validate_sector(file, {.ignored = ignored});
    ASSERT_EQ(report.findings.size(), 1u);
    EXPECT_EQ(report.findings[0].issue, &issue::settings_range);
    EXPECT_EQ(report.errors, 1u);
}

TEST(Validator, FindingHasTheValueThatBreaksTheRule) {
    EXPECT_EQ(validate_sector(golden_with([](Sector& s) { s.probes[1].transfer[2][3][1] = INT16_MIN; }))
                  .findings.at(0)
                  .value,
              -32768.0);
    EXPECT_EQ(validate_sector(golden_with([](Sector& s) { s.grid.cells[5] = 200; })).findings.at(0).value,
              200.0);
    EXPECT_EQ(validate_sector(Edit(golden_bytes()).cut(100).as_is()).findings.at(0).value, std::nullopt);
}

TEST(Validator, WarningsLeaveAFileValid) {
    const Report report = validate_sector(with_one_more(golden_bytes(), {77, 5, 9, 3, {1, 2, 3}}));
    EXPECT_EQ(report.warnings, 1u);
    EXPECT_TRUE(report.valid());
}

}  // namespace
}  // namespace drtv::test
