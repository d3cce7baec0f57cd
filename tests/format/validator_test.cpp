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

Bytes golden_with(const std::function<void(Sector&)>& change, Codec codec = Codec::raw) { return changed(golden_sector(), change, codec); }

// The optional sections stand at 4912, 4992 and 5232 there: three probes, three local sources, five pairs.
Bytes golden_1_1_with(const std::function<void(Sector&)>& change) { return changed(golden_sector_1_1(), change); }

Bytes with_sources_of_one_probe(std::size_t count) {
    return golden_1_1_with([&](Sector& s) {
        LocalTransfer& local = s.local_transfer.emplace();
        local.sources = neighbouring_sources(count);
        local.receivers.resize(s.probes.size());
        for (std::size_t source = 0; source < count; ++source) add_pairs(local, 1, {source}, {});
    });
}

std::string report_of(const Bytes& file) {
    std::string report;
    for (const Finding& finding : validate_sector(file)) {
        if (!report.empty()) report += '\n';
        report += std::string(finding.issue->code) + " at " + std::to_string(finding.offset) + ", " + finding.path + ": " + finding.message;
    }
    return report;
}

const std::vector<Case> cases = {
    {"Cut", [] { return Edit(golden_bytes()).cut(4000).as_is(); }, "STRUCTURE at 4000, : the header says 4680 bytes, the file has 4000"},
    {"Text", [] { return Bytes{'h', 'e', 'l', 'l', 'o'}; }, "STRUCTURE at 0, : not a drtv sector file: it does not start with \"DRTV\""},
    {"ChangedByte", [] { return Edit(golden_bytes()).u8(340, 1).as_is(); },
     "CHECKSUM at 336, : transfer section (kind 4): its checksum does not match its bytes"},
    {"OtherMajor", [] { return Edit(golden_bytes()).u16(at::major, 2).sealed(); },
     "UNSUPPORTED_VERSION at 4, : format version 2.0 is not supported: this reader knows version 1"},
    {"OtherSectionVersion", [] { return Edit(golden_bytes()).u16(entry(4) + at::version, 2).sealed(); },
     "UNSUPPORTED_VERSION at 528, : grid section (kind 5) has version 2, this reader knows 1"},
    {"ReservedCodeInTransfer", [] { return golden_with([](Sector& s) { s.probes[1].transfer[2][3][1] = INT16_MIN; }); },
     "FIXED_POINT_RESERVED at 522, probe[1].transfer.b[3][1]: code -32768 is reserved"},
    {"ReservedCodeInSkyVisibility", [] { return golden_with([](Sector& s) { s.probes[1].sky_visibility[2] = INT16_MIN; }); },
     "FIXED_POINT_RESERVED at 332, probe[1].sky_visibility[2]: code -32768 is reserved"},
    {"NegativeSkyVisibility", [] { return golden_with([](Sector& s) { s.probes[0].sky_visibility[1] = -1; }); },
     "SKY_VISIBILITY_RANGE at 322, probe[0].sky_visibility[1]: code -1 is negative"},
    {"SkyBelow", [] { return golden_with([](Sector& s) { s.probes[1].sky_visibility[3] = 1; }); },
     "SKY_VISIBILITY_DOWN at 334, probe[1].sky_visibility[3]: code 1, must be 0"},
    {"TransferOverY0", [] { return golden_with([](Sector& s) { s.probes[0].transfer[0][0][0] = 18488; }); },
     "TRANSFER_RANGE at 336, probe[0].transfer.r[0][0]: 0.282113 is beyond 0.282100"},
    {"TransferUnderY1", [] { return golden_with([](Sector& s) { s.probes[0].transfer[1][2][3] = -32027; }); },
     "TRANSFER_RANGE at 390, probe[0].transfer.g[2][3]: -0.488708 is beyond 0.488700"},
    {"GridNamesNoSuchProbe", [] { return golden_with([](Sector& s) { s.grid.cells[4095] = 2; }); },
     "GRID_REFERENCE at 4639, grid.cells[4095]: names probe 2, the sector has 2"},
    {"GridOfEmptySectorNamesAProbe",
     [] { return golden_with([](Sector& s) { s.probes.clear(); s.grid.cells.fill(no_probe); s.grid.cells[1] = 0; }); },
     "GRID_REFERENCE at 321, grid.cells[1]: names probe 0, the sector has 0"},
    {"GridCellEmpty", [] { return golden_with([](Sector& s) { s.grid.cells[0] = no_probe; }); },
     "GRID_NO_PROBE at 544, grid.cells[0]: names no probe, the sector has 2"},
    {"NoRays", [] { return golden_with([](Sector& s) { s.bake.rays = 0; }); }, "SETTINGS_RANGE at 256, settings.rays: is 0"},
    {"NoReach", [] { return golden_with([](Sector& s) { s.bake.reach_m = 0; }); },
     "SETTINGS_RANGE at 264, settings.reach: 0.000000 m is not positive"},
    {"NegativeDistance", [] { return golden_with([](Sector& s) { s.bake.min_distance_m = -1; }); },
     "SETTINGS_RANGE at 268, settings.min_distance: -1.000000 m is not positive"},
    {"TwoProbesAtOnePlace", [] { return golden_with([](Sector& s) { s.probes[1].position = s.probes[0].position; }); },
     "DUPLICATE_POSITION at 312, probe[1].position: is that of probe 0"},
    {"ThreeProbesAtOnePlace",
     [] { return golden_with([](Sector& s) { s.probes[1].position = s.probes[0].position; s.probes.push_back(s.probes[0]); }); },
     "DUPLICATE_POSITION at 312, probe[1].position: is that of probe 0\nDUPLICATE_POSITION at 320, probe[2].position: is that of probe 0"},
    {"SeveralInTheOrderOfTheFile",
     [] {
         return golden_with([](Sector& s) {
             s.grid.cells[7] = 9;
             s.bake.rays = 0;
             s.probes[0].transfer[0][0][1] = INT16_MIN;
         });
     },
     "SETTINGS_RANGE at 256, settings.rays: is 0\nFIXED_POINT_RESERVED at 338, probe[0].transfer.r[0][1]: code -32768 is reserved\n"
     "GRID_REFERENCE at 551, grid.cells[7]: names probe 9, the sector has 2"},
    {"ReservedCodeInStaticIrradiance", [] { return golden_1_1_with([](Sector& s) { s.static_irradiance[2].codes[1][0] = INT16_MIN; }); },
     "FIXED_POINT_RESERVED at 4968, probe[2].static_irradiance.g[0]: code -32768 is reserved"},
    {"NegativeStaticIrradiance", [] { return golden_1_1_with([](Sector& s) { s.static_irradiance[0].codes[2][3] = -1; }); },
     "STATIC_IRRADIANCE_RANGE at 4934, probe[0].static_irradiance.b[3]: code -1 is negative"},
    {"StaticExponentTooSmall", [] { return golden_1_1_with([](Sector& s) { s.static_irradiance[1].exponent = -65; }); },
     "STATIC_EXPONENT at 4985, probe[1].static_irradiance.exponent: -65 is not between -64 and 64"},
    {"StaticExponentTooLarge", [] { return golden_1_1_with([](Sector& s) { s.static_irradiance[2].exponent = 65; }); },
     "STATIC_EXPONENT at 4986, probe[2].static_irradiance.exponent: 65 is not between -64 and 64"},
    {"TooManySourcesOfOneProbe", [] { return with_sources_of_one_probe(129); },
     "LOCAL_SOURCE_COUNT at 5600, probe[1].local: takes light from 129 sources, over the limit of 128"},
    {"SourceTwice", [] { return golden_1_1_with([](Sector& s) { s.local_transfer->sources[1].probe = 0; }); },
     "LOCAL_SOURCE_DUPLICATE at 5012, local_transfer.sources[1]: is that of source 0"},
    {"ReservedCodeInLocalTransfer", [] { return golden_1_1_with([](Sector& s) { s.local_transfer->pairs[3][1][0] = INT16_MIN; }); },
     "FIXED_POINT_RESERVED at 5184, probe[1].local[2].g[0]: code -32768 is reserved"},
    {"LocalExponentTooSmall", [] { return golden_1_1_with([](Sector& s) { s.local_transfer->receivers[2].exponent = -124; }); },
     "LOCAL_EXPONENT at 5044, probe[2].local[0]: exponents -124 and -3 add up to -127, not between -126 and 63"},
    {"LocalExponentTooLarge", [] { return golden_1_1_with([](Sector& s) { s.local_transfer->receivers[0].exponent = 64; }); },
     "LOCAL_EXPONENT at 5028, probe[0].local[0]: exponents 64 and 0 add up to 64, not between -126 and 63"},
    {"LocalTransferNegative", [] { return golden_1_1_with([](Sector& s) { s.local_transfer->pairs[0][0] = {-1, 0, 0, 0}; }); },
     "LOCAL_TRANSFER_RANGE at 5104, probe[0].local[0].r[0]: code -1 is negative"},
    {"LocalTransferOverBand0", [] { return golden_1_1_with([](Sector& s) { s.local_transfer->pairs[4][2] = {10000, 0, 0, -11550}; }); },
     "LOCAL_TRANSFER_RANGE at 5222, probe[2].local[0].b[3]: code -11550 is beyond 1.1548 times code 10000 of band 0"},
    {"NegativeErrorAsked", [] { return golden_1_1_with([](Sector& s) { s.convergence->error_asked = -1; }); },
     "CONVERGENCE_RANGE at 5232, convergence.error_asked: -1.000000 is less than 0"},
    {"NegativeMedian", [] { return golden_1_1_with([](Sector& s) { s.convergence->error_median = -1; }); },
     "CONVERGENCE_RANGE at 5236, convergence.error_median: -1.000000 is less than 0"},
    {"ErrorsOutOfOrder", [] { return golden_1_1_with([](Sector& s) { s.convergence = {0, 3, 2, 1, 0, 0, 0, 0, 0, 0}; }); },
     "CONVERGENCE_RANGE at 5240, convergence.error_p95: 2.000000 is less than the median\n"
     "CONVERGENCE_RANGE at 5244, convergence.error_max: 1.000000 is less than the 95th percentile"},
    {"MostPathsFewerThanLeast", [] { return golden_1_1_with([](Sector& s) { s.convergence->paths_most = 255; }); },
     "CONVERGENCE_RANGE at 5252, convergence.paths_most: 255 is less than the least"},
};

class SectorValidator : public testing::TestWithParam<Case> {};

TEST_P(SectorValidator, IsReported) { EXPECT_EQ(report_of(GetParam().file()), GetParam().report); }

INSTANTIATE_TEST_SUITE_P(, SectorValidator, testing::ValuesIn(cases), [](const auto& c) { return c.param.name; });

TEST(ValidatorIssues, EachHasACase) {
    for (const Issue& issue : all_issues()) {
        const std::string start = std::string(issue.code) + " at ";
        EXPECT_TRUE(std::any_of(cases.begin(), cases.end(), [&](const Case& c) { return c.report.starts_with(start); })) << issue.code;
    }
}

TEST(ValidatorIssues, CodesAreUniqueAndExplained) {
    std::set<std::string_view> codes;
    for (const Issue& issue : all_issues()) {
        EXPECT_TRUE(codes.insert(issue.code).second) << issue.code;
        EXPECT_FALSE(issue.meaning.empty());
    }
}

TEST(ValidatorIssues, StandInTheSpecification) {
    const Bytes page = read_test_file(DRTV_SOURCE_DIR "/format/SPEC.md");
    const std::string text(page.begin(), page.end());
    for (const Issue& issue : all_issues()) EXPECT_NE(text.find('`' + std::string(issue.code) + '`'), std::string::npos) << issue.code;
}

TEST(Validator, FindingInAPackedSectionPointsAtItsFirstByte) {
    const Bytes file = golden_with([](Sector& s) { s.grid.cells[4000] = 7; }, Codec::zstd);
    const auto findings = validate_sector(file);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].offset, section_start(file, 5));
}

TEST(Validator, StopsAtTheNumberOfFindingsAskedFor) {
    const Bytes file = golden_with([](Sector& s) { s.grid.cells.fill(no_probe); });
    EXPECT_EQ(validate_sector(file, 3).size(), 3u);
    EXPECT_EQ(validate_sector(file).size(), 100u);
    EXPECT_EQ(validate_sector(file, 10'000).size(), 4096u);
}

TEST(Validator, EndsOfTheOptionalRangesAreAllowed) {
    EXPECT_EQ(report_of(golden_bytes_1_1()), "");  // the smallest exponents, and the largest band 1
    EXPECT_EQ(report_of(with_sources_of_one_probe(128)), "");
    EXPECT_EQ(report_of(golden_1_1_with([](Sector& s) {
                  s.static_irradiance[0].exponent = 64;
                  s.local_transfer->receivers[0].exponent = 63;
                  s.convergence = Convergence{};
              })),
              "");
}

TEST(Validator, LargestPassiveTransferIsAllowed) {
    EXPECT_EQ(report_of(golden_with([](Sector& s) {
                  s.probes[0].transfer[0][0] = {18487, 32026, -32026, 32026};
                  s.probes[0].transfer[0][1] = {-18487, 0, 0, 0};
              })),
              "");
}

}  // namespace
}  // namespace drtv::test
