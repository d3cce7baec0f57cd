#include "client/job_report.h"

#include <gtest/gtest.h>

namespace drtv::client {
namespace {

v1::Sector baked(std::int32_t i, std::int64_t probes, double median, double transfer_s) {
    v1::Sector sector;
    sector.mutable_coordinate()->set_i(i);
    sector.set_state(v1::Sector::DONE);
    sector.set_origin(v1::Sector::BAKED);
    sector.set_cause("palm moved");
    sector.set_probes(probes);
    sector.mutable_reached_error()->set_median(median);
    sector.mutable_reached_error()->set_p95(2 * median);
    sector.mutable_reached_error()->set_max(3 * median);
    sector.mutable_reached_error()->set_budget_ended(1);
    sector.mutable_stages()->set_transfer(transfer_s);
    sector.mutable_stages()->set_files(0.25);
    sector.mutable_placement()->set_candidates(100);
    sector.mutable_placement()->set_thinned(2);
    return sector;
}

TEST(JobReport, SumsStagesAndPlacesAndRanksTheSlowest) {
    JobReport report;
    report.add(baked(1, 10, 0.01, 1));
    report.add(baked(2, 10, 0.01, 3));
    report.add(baked(3, 10, 0.01, 2));
    EXPECT_EQ(report.stages.transfer(), 6);
    EXPECT_EQ(total_of(report.stages), 6.75);
    EXPECT_EQ(report.placement.candidates(), 300);
    EXPECT_EQ(report.placement.thinned(), 6);
    const auto slowest = report.slowest(2);
    ASSERT_EQ(slowest.size(), 2u);
    EXPECT_EQ(slowest[0].coordinate().i(), 2);
    EXPECT_EQ(slowest[1].coordinate().i(), 3);
}

TEST(JobReport, ErrorsAreWeightedByProbes) {
    JobReport report;
    report.add(baked(1, 96, 0.01, 1));
    report.add(baked(2, 2, 0.1, 1));
    report.add(baked(3, 2, 0.2, 1));
    EXPECT_EQ(report.error().median(), 0.01);
    EXPECT_EQ(report.error().p95(), 0.02);
    EXPECT_DOUBLE_EQ(report.error().max(), 0.6);
    EXPECT_EQ(report.error().budget_ended(), 3);
    report.add(baked(4, 100, 0.3, 1));
    EXPECT_EQ(report.error().median(), 0.2);
    EXPECT_EQ(JobReport().error().median(), 0);
}

TEST(JobReport, AHitHasPlacesAndErrorsAndNoTime) {
    JobReport report;
    v1::Sector hit = baked(1, 10, 0.01, 1);
    hit.set_origin(v1::Sector::HIT);
    hit.clear_stages();
    hit.clear_cause();
    report.add(hit);
    EXPECT_TRUE(report.slowest(5).empty());
    EXPECT_TRUE(report.causes().empty());
    EXPECT_EQ(report.placement.candidates(), 100);
    EXPECT_EQ(report.error().median(), 0.01);
}

TEST(JobReport, WhatAnOlderServerDidNotKeepCountsAsUnknown) {
    JobReport report;
    report.add(baked(1, 10, 0.01, 1));
    v1::Sector old = baked(2, 1000, 0, 1);
    old.set_origin(v1::Sector::ORIGIN_UNSPECIFIED);
    old.clear_stages();
    old.clear_placement();
    old.clear_reached_error();
    report.add(old);
    EXPECT_EQ(report.unknown, 1);
    EXPECT_EQ(report.error().median(), 0.01);
    EXPECT_EQ(report.placement.candidates(), 100);
}

TEST(JobReport, ANearHitIsNoCauseOfBaking) {
    JobReport report;
    v1::Sector near = baked(1, 10, 0.01, 1);
    near.set_origin(v1::Sector::NEAR_HIT);
    near.clear_stages();
    report.add(near);
    EXPECT_TRUE(report.causes().empty());
}

TEST(JobReport, CausesCountWhatWaitsToo) {
    JobReport report;
    v1::Sector waiting;
    waiting.set_state(v1::Sector::PENDING);
    waiting.set_cause("its earlier result is lost");
    report.add(waiting);
    report.add(baked(1, 1, 0.1, 1));
    report.add(baked(2, 1, 0.1, 1));
    const std::vector<std::pair<std::string, std::int64_t>> causes = {{"palm moved", 2},
                                                                      {"its earlier result is lost", 1}};
    EXPECT_EQ(report.causes(), causes);
    EXPECT_EQ(report.placement.candidates(), 200);
}

TEST(JobReport, WarningsStandWithTheirObjectOnce) {
    JobReport report;
    for (int i = 0; i < 3; ++i) {
        v1::Sector sector = baked(i, 1, 0.1, 1);
        sector.add_warnings("no probe under 'dome' sees the sky: use bake_role 'ignore'");
        sector.add_warnings("sector (" + std::to_string(i) + ", 0): its rays meet 'wall' from behind");
        sector.add_warnings("no name here");
        report.add(sector);
    }
    ASSERT_EQ(report.warnings.size(), 3u);
    ASSERT_EQ(report.warnings["dome"].size(), 1u);
    EXPECT_EQ(report.warnings["dome"][0].sectors, 3);
    EXPECT_EQ(report.warnings["wall"].size(), 3u);
    EXPECT_EQ(report.warnings[""].size(), 1u);
    EXPECT_EQ(report.warning_count(), 5);
}

TEST(JobReport, FailuresAreTold) {
    JobReport report;
    v1::Sector failed;
    failed.set_state(v1::Sector::FAILED);
    failed.set_error("too high");
    report.add(failed);
    ASSERT_EQ(report.failures.size(), 1u);
    EXPECT_EQ(report.failures[0].sentence, "too high");
    EXPECT_EQ(report.placement.candidates(), 0);
}

TEST(NamedThing, IsTheFirstNameInQuotes) {
    EXPECT_EQ(named_thing("the light 'Sun' at (1, 2, 3) is enclosed by 'bulb'"), "Sun");
    EXPECT_EQ(named_thing("rays of 'bob's house': are its faces turned?"), "bob's house");
    EXPECT_EQ(named_thing("under 'roof'"), "roof");
    EXPECT_EQ(named_thing("lies inside 'a b c', which is closed"), "a b c");
    EXPECT_EQ(named_thing("under an object without a name sees: use bake_role 'ignore'"), "");
    EXPECT_EQ(named_thing("a sentence"), "");
    EXPECT_EQ(named_thing("an open 'quote"), "");
    EXPECT_EQ(named_thing(""), "");
}

}  // namespace
}  // namespace drtv::client
