#include "tests/farm/books.h"

namespace drtv::farm {
namespace {

using JobTableTest = BooksTest;

JobSectorRow done(std::int64_t job, map::SectorCoordinate sector) {
    JobSectorRow row = sector_row(job, sector, SectorState::done);
    row.file = digest_of("file");
    row.file_bytes = 100;
    row.probes = 10;
    row.rays = 1LL << 40;
    row.bound = 0.25f;
    row.warnings = {"one", "two"};
    return row;
}

JobSectorRow failed(std::int64_t job, map::SectorCoordinate sector) {
    JobSectorRow row = sector_row(job, sector, SectorState::failed);
    row.failed_attempts = 3;
    row.error = "it's \"bad\"";
    return row;
}

TEST_F(JobTableTest, AReopenedFileHasAllOfIt) {
    const JobRow job = add_job({{-3, 5}, {2, 0}}, "request");
    write([&](Connection& connection) { EXPECT_TRUE(record_sector(connection, done(job.id, {-3, 5}))); });
    reopen();
    const Checked<JobRow> back = this->job(job.id);
    EXPECT_TRUE(back.sound);
    EXPECT_EQ(std::tuple(back.row.request_id, back.row.manifest, back.row.inventory, back.row.preset),
              std::tuple(job.request_id, job.manifest, job.inventory, job.preset));
    EXPECT_EQ(back.row.settings, job.settings);  // floats to their last bit
    ASSERT_TRUE(back.row.region);
    EXPECT_EQ(std::tuple(back.row.region->x0, back.row.region->y0, back.row.region->x1, back.row.region->y1),
              std::tuple(0, -1.5, 0.1, 1));
    EXPECT_EQ(std::tuple(back.row.state, back.row.created_ms, back.row.ended_ms),
              std::tuple(JobState::running, 1000, 0));
    EXPECT_EQ(
        std::tuple(back.row.sectors_total, back.row.sectors_done, back.row.probes, back.row.largest_bound),
        std::tuple(2, 1, 10, 0.25f));
    const Checked<JobSectorRow> sector = this->sector(job.id, {-3, 5});
    EXPECT_TRUE(sector.sound);
    EXPECT_EQ(std::tuple(sector.row.state, sector.row.file, sector.row.file_bytes, sector.row.rays),
              std::tuple(SectorState::done, digest_of("file"), 100, 1LL << 40));
    EXPECT_EQ(sector.row.warnings, (std::vector<std::string>{"one", "two"}));
    EXPECT_FALSE(read([&](Connection& connection) { return find_job(connection, 77); }));
    EXPECT_FALSE(read([&](Connection& connection) { return sector_of_job(connection, job.id, {9, 9}); }));
}

TEST_F(JobTableTest, WhatABakeTookAndCameToIsKept) {
    const JobRow job = add_job({{0, 0}, {1, 0}});
    const worker::SectorResult result = this->result("a");
    write([&](Connection& connection) {
        JobSectorRow waiting = sector_row(job.id, {0, 0});
        waiting.cause = "palm moved";
        replace_sector(connection, waiting);
        EXPECT_TRUE(record_sector(connection, baked_row(job.id, {0, 0}, result)));
        EXPECT_TRUE(record_sector(connection, reused_row(job.id, {1, 0}, result, 0.5f)));
    });
    const Checked<JobSectorRow> baked = sector(job.id, {0, 0});
    EXPECT_TRUE(baked.sound);
    EXPECT_EQ(baked.row.cause, "palm moved");
    EXPECT_EQ(baked.row.origin, SectorOrigin::baked);
    EXPECT_EQ(std::tuple(baked.row.numbers, baked.row.stages), std::tuple(result.numbers, result.stages));
    const Checked<JobSectorRow> near = sector(job.id, {1, 0});
    EXPECT_EQ(std::tuple(near.row.origin, near.row.numbers, near.row.stages),
              std::tuple(SectorOrigin::near_hit, result.numbers, StageSeconds()));
}

TEST_F(JobTableTest, TheLastSectorEndsTheJob) {
    const JobRow job = add_job({{0, 0}, {1, 0}, {2, 0}});
    write([&](Connection& connection) {
        EXPECT_EQ(record_sector(connection, done(job.id, {1, 0}))->state, JobState::running);
        EXPECT_EQ(record_sector(connection, done(job.id, {0, 0}))->state, JobState::running);
        EXPECT_EQ(record_sector(connection, done(job.id, {2, 0}))->state, JobState::succeeded);
    });
    EXPECT_EQ(this->job(job.id).row.sectors_done, 3);
    EXPECT_GT(this->job(job.id).row.ended_ms, 0);
}

TEST_F(JobTableTest, AFailedSectorFailsTheJobWithTheFirstReason) {
    const JobRow job = add_job({{1, 0}, {0, 1}, {0, 0}});
    write([&](Connection& connection) {
        EXPECT_TRUE(record_sector(connection, failed(job.id, {0, 1})));
        EXPECT_TRUE(record_sector(connection, failed(job.id, {1, 0})));
        EXPECT_TRUE(record_sector(connection, done(job.id, {0, 0})));
    });
    EXPECT_EQ(this->job(job.id).row.state, JobState::failed);
    EXPECT_EQ(this->job(job.id).row.error, "2 of 3 sectors failed; sector (1, 0): it's \"bad\"");
}

TEST_F(JobTableTest, ASectorCountsOnceAndNotForAJobThatHasEnded) {
    const JobRow job = add_job({{0, 0}, {1, 0}});
    write([&](Connection& connection) {
        EXPECT_TRUE(record_sector(connection, done(job.id, {0, 0})));
        EXPECT_EQ(record_sector(connection, done(job.id, {0, 0}))->sectors_done, 1);
        JobRow cancelled = find_job(connection, job.id)->row;
        cancelled.state = JobState::cancelled;
        update_job(connection, cancelled);
        EXPECT_FALSE(record_sector(connection, done(job.id, {1, 0})));
    });
    EXPECT_EQ(this->job(job.id).row.sectors_done, 1);
}

TEST_F(JobTableTest, SectorsComeByRowThenColumnInPages) {
    std::vector<map::SectorCoordinate> sectors;
    for (std::int32_t n = 0; n < 9; ++n)
        sectors.push_back({1 - n % 3, 1 - n / 3});
    const JobRow job = add_job(sectors), other = add_job({{0, 0}});
    std::vector<map::SectorCoordinate> seen;
    for (int page = 0; page < 3; ++page) {
        const auto after = seen.empty() ? std::nullopt : std::optional(seen.back());
        for (const auto& row :
             read([&](Connection& connection) { return sectors_of_job(connection, job.id, after, 4); }))
            seen.push_back(row.row.sector);
    }
    EXPECT_EQ(seen, (std::vector<map::SectorCoordinate>{
                        {-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {0, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}));
    EXPECT_EQ(read([&](Connection& connection) { return sectors_of_job(connection, other.id); }).size(), 1u);
}

TEST_F(JobTableTest, WarningsComeByRowThenColumn) {
    const JobRow job = add_job({{5, 1}, {-2, 0}, {7, -1}, {3, -2}});
    const auto add = [&](map::SectorCoordinate sector, std::vector<std::string> warnings) {
        JobSectorRow row = done(job.id, sector);
        row.warnings = std::move(warnings);
        write([&](Connection& connection) { EXPECT_TRUE(record_sector(connection, row)); });
    };
    add({5, 1}, {"d", "a"});  // what was said is not said again
    add({-2, 0}, {"b", "c"});
    add({7, -1}, {"a"});
    add({3, -2}, {});
    const auto warnings = [&](std::size_t max) {
        return read([&](Connection& connection) { return warnings_of_job(connection, job.id, max); });
    };
    using Sentences = std::vector<std::string>;
    EXPECT_EQ(warnings(20), (Sentences{"a", "b", "c", "d"}));
    EXPECT_EQ(warnings(2), (Sentences{"a", "b"}));
    EXPECT_EQ(warnings(0), Sentences{});
}

TEST_F(JobTableTest, ARequestIdNamesOneJob) {
    add_job({}, "same");
    add_job({});
    add_job({});
    const auto second = database->write([&](Connection& connection) {
        JobRow job;
        job.request_id = "same";
        insert_job(connection, job);
    });
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("UNIQUE"), std::string::npos) << second.error().message;
    EXPECT_EQ(read(all_jobs).size(), 3u);
}

// One character is enough: the settings of another job, a file of another sector.
TEST_F(JobTableTest, ARowThatSomebodyElseChangedIsNotSound) {
    const JobRow job = add_job({{0, 0}, {1, 0}});
    write([&](Connection& connection) { EXPECT_TRUE(record_sector(connection, done(job.id, {0, 0}))); });
    change("UPDATE job SET setting_rays = 98");
    EXPECT_FALSE(this->job(job.id).sound);
    change("UPDATE job SET setting_rays = 99");
    EXPECT_TRUE(this->job(job.id).sound);
    change("UPDATE job_sector SET file = replace(file, substr(file, 9, 1), 'x') WHERE i = 0");
    EXPECT_FALSE(sector(job.id, {0, 0}).sound);
    EXPECT_TRUE(sector(job.id, {1, 0}).sound);
}

TEST_F(JobTableTest, NegativeZeroIsKeptAsASoundZero) {
    JobRow job;
    job.region = JobRegion{-0.0, -0.0, 1, 1};
    job.settings.bake.error = -0.0f;
    write([&](Connection& connection) { insert_job(connection, job); });
    EXPECT_TRUE(this->job(job.id).sound);
}

TEST_F(JobTableTest, ARequestWhoseJobWasNotWrittenWholeMayBeMadeAgain) {
    for (int n = 0; n < 2; ++n) {
        JobRow job;
        job.request_id = "same";
        write([&](Connection& connection) { insert_job(connection, job); });
    }
    EXPECT_EQ(read(all_jobs).size(), 1u);
}

TEST_F(JobTableTest, WhatWasNotWrittenWholeIsGoneAtTheNextStart) {
    const JobRow whole = add_job({{0, 0}});
    write([&](Connection& connection) {
        JobRow job;
        insert_job(connection, job);
        insert_sectors(connection, std::vector{sector_row(job.id, {1, 1})});
    });
    EXPECT_EQ(read(all_jobs).size(), 2u);
    write([](Connection& connection) { remove_unfinished_jobs(connection); });
    const auto left = read(all_jobs);
    ASSERT_EQ(left.size(), 1u);
    EXPECT_EQ(left[0].row.id, whole.id);
    EXPECT_TRUE(sector(whole.id, {0, 0}).sound);
}

TEST_F(JobTableTest, ATransactionThatFailsLeavesNothing) {
    const auto failed = database->write([&](Connection& connection) {
        JobRow job;
        insert_job(connection, job);
        connection.execute("INSERT INTO no_such_table VALUES (1)");
    });
    ASSERT_FALSE(failed);
    EXPECT_NE(failed.error().message.find("no_such_table"), std::string::npos) << failed.error().message;
    EXPECT_TRUE(read(all_jobs).empty());
    add_job({});
    EXPECT_EQ(read(all_jobs).size(), 1u);
}

}  // namespace
}  // namespace drtv::farm
