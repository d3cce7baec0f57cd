// What the database did not take is not done.
#include "bakerd/farm/recorder.h"
#include "bakerd/farm/job_store.h"
#include "tests/farm/books.h"

#include <atomic>
#include <thread>

namespace drtv::farm {
namespace {

using namespace std::chrono_literals;

class RecorderTest : public BooksTest {
  protected:
    RecorderTest() : cache(*database, *blobs, INT64_MAX) { start(); }
    ~RecorderTest() override { recorder->stop(); }

    void start() {
        recorder = std::make_unique<Recorder>(
            *database, cache, book, [this] { ++woken; }, 20ms);
    }

    // In the database and in the book.
    JobRow add(const std::vector<map::SectorCoordinate>& sectors) {
        JobRow job = add_job(sectors);
        std::vector<WantedSector> wanted;
        for (const map::SectorCoordinate& sector : sectors)
            wanted.push_back({sector, std::nullopt});
        book.add(job, wanted);
        return job;
    }
    // The next sector of the queue as if it had been baked.
    FinishedSector bake_next() {
        const executor::SectorTask task = book.next(executor::Priority::interactive).value();
        return book.finish({task.id, 0, result("file " + std::to_string(task.id))}).value();
    }
    JobView wait(std::int64_t id, const std::function<bool(const JobView&)>& enough) {
        JobView view = book.view(id).value();
        for (int n = 0; n < 1000 && !enough(view); ++n)
            view = book.wait_for_change(id, view.version, 20ms).value();
        EXPECT_TRUE(enough(view)) << view.row.sectors_done << " done, " << view.row.error;
        return view;
    }
    static bool has_ended(const JobView& view) { return view.row.state != JobState::running; }

    ResultCache cache;
    JobBook book;
    std::atomic<int> woken = 0;
    std::unique_ptr<Recorder> recorder;
};

TEST_F(RecorderTest, WritesTheSectorTheJobAndTheResult) {
    const JobRow job = add({{0, 0}, {1, 0}});
    recorder->record(bake_next());
    wait(job.id, [](const JobView& view) { return view.row.sectors_done == 1; });
    recorder->record(bake_next());
    EXPECT_EQ(wait(job.id, has_ended).row.state, JobState::succeeded);
    EXPECT_EQ(this->job(job.id).row.state, JobState::succeeded);
    EXPECT_EQ(sector(job.id, {0, 0}).row.file, digest_of("file 1"));
    EXPECT_EQ(cache.counts()->results, 2);
    EXPECT_EQ(book.view(job.id)->rays, 2LL << 40);
}

// Another program holds the file for longer than anybody is ready to wait.
TEST_F(RecorderTest, WhileTheDatabaseIsLockedNothingIsDoneAndNothingIsLost) {
    const JobRow job = add({{0, 0}, {1, 0}, {2, 0}});
    SQLite::Database other(path, SQLite::OPEN_READWRITE);
    other.exec("BEGIN EXCLUSIVE");
    for (int n = 0; n < 3; ++n)
        recorder->record(bake_next());
    const JobView waiting = wait(job.id, [](const JobView& view) { return !view.warnings.empty(); });
    EXPECT_NE(waiting.warnings[0].find("waits to be written"), std::string::npos) << waiting.warnings[0];
    std::this_thread::sleep_for(200ms);
    EXPECT_EQ(book.view(job.id)->row.sectors_done, 0);
    EXPECT_EQ(book.view(job.id)->row.state, JobState::running);
    other.exec("ROLLBACK");
    EXPECT_EQ(wait(job.id, has_ended).row.state, JobState::succeeded);
    EXPECT_EQ(this->job(job.id).row.sectors_done, 3);
    for (int n = 0; n < 3; ++n)
        EXPECT_TRUE(blobs->has(sector(job.id, {n, 0}).row.file));
}

TEST_F(RecorderTest, WhatIsRefusedUntilTheEndWaitsAgainAfterARestart) {
    const JobRow job = add({{0, 0}, {1, 0}});
    recorder->record(bake_next());
    wait(job.id, [](const JobView& view) { return view.row.sectors_done == 1; });
    SQLite::Database other(path, SQLite::OPEN_READWRITE);
    other.exec("BEGIN EXCLUSIVE");
    recorder->record(bake_next());
    recorder->stop();
    other.exec("ROLLBACK");
    JobBook after;
    ASSERT_TRUE(load_jobs(*database, after));
    EXPECT_EQ(after.view(job.id)->row.state, JobState::running);
    EXPECT_EQ(after.view(job.id)->row.sectors_done, 1);
    EXPECT_EQ(after.next(executor::Priority::interactive)->request.sector, (map::SectorCoordinate{1, 0}));
}

TEST_F(RecorderTest, AJobThatJoinsWhileASectorIsAtWorkGetsItToo) {
    const JobRow one = add({{0, 0}});
    FinishedSector finished = bake_next();
    const JobRow two = add({{0, 0}});
    EXPECT_FALSE(book.next(executor::Priority::interactive)) << "it is at work";
    recorder->record(std::move(finished));
    EXPECT_EQ(wait(one.id, has_ended).row.state, JobState::succeeded);
    EXPECT_EQ(wait(two.id, has_ended).row.state, JobState::succeeded);
    EXPECT_EQ(sector(two.id, {0, 0}).row.file, sector(one.id, {0, 0}).row.file);
    EXPECT_EQ(cache.counts()->results, 1);
}

TEST_F(RecorderTest, TheResultOfACancelledJobIsKeptAndNotCounted) {
    JobRow job = add({{0, 0}, {1, 0}});
    FinishedSector finished = bake_next();
    job.state = JobState::cancelled;
    write([&](Connection& connection) { update_job(connection, job); });
    book.update(job);
    recorder->record(std::move(finished));
    recorder->stop();
    EXPECT_EQ(book.view(job.id)->row.sectors_done, 0);
    EXPECT_EQ(sector(job.id, {0, 0}).row.state, SectorState::waiting);
    EXPECT_EQ(cache.counts()->results, 1);
    EXPECT_FALSE(book.next(executor::Priority::interactive)) << "nobody wants the other one";
}

TEST_F(RecorderTest, AFileThatLeftTheStoreBeforeItWasRecordedIsBakedAgain) {
    const JobRow job = add({{0, 0}});
    FinishedSector finished = bake_next();
    blobs->remove(finished.end.reply->blobs.file);
    recorder->record(std::move(finished));
    for (int n = 0; n < 500 && woken == 0; ++n)
        std::this_thread::sleep_for(10ms);
    EXPECT_EQ(book.view(job.id)->row.sectors_done, 0);
    recorder->record(bake_next());
    EXPECT_EQ(wait(job.id, has_ended).row.state, JobState::succeeded);
}

// They wait while the database is locked, and are then tried together.
TEST_F(RecorderTest, OneOfManyWhoseFileLeftTheStoreDoesNotHoldTheOthersUp) {
    std::vector<map::SectorCoordinate> sectors;
    for (int i = 0; i < 200; ++i)
        sectors.push_back({i, 0});
    const JobRow job = add(sectors);
    std::vector<FinishedSector> finished;
    for (int n = 0; n < 200; ++n)
        finished.push_back(bake_next());
    const JobRow joined = add({{7, 0}});
    SQLite::Database other(path, SQLite::OPEN_READWRITE);
    other.exec("BEGIN EXCLUSIVE");
    blobs->remove(finished[40].end.reply->blobs.file);
    for (FinishedSector& sector : finished)
        recorder->record(std::move(sector));
    wait(job.id, [](const JobView& view) { return !view.warnings.empty(); });
    other.exec("ROLLBACK");
    wait(job.id, [](const JobView& view) { return view.row.sectors_done == 199; });
    for (int n = 0; n < 500 && woken == 0; ++n)
        std::this_thread::sleep_for(10ms);
    EXPECT_EQ(cache.counts()->results, 199);
    EXPECT_EQ(wait(joined.id, has_ended).row.state, JobState::succeeded);
    recorder->record(bake_next());
    EXPECT_EQ(wait(job.id, has_ended).row.state, JobState::succeeded);
    EXPECT_EQ(this->job(job.id).row.sectors_done, 200);
    EXPECT_EQ(cache.counts()->results, 200);
}

TEST_F(RecorderTest, AFailureIsTheSectors) {
    const JobRow job = add({{0, 0}});
    const executor::SectorTask task = book.next(executor::Priority::interactive).value();
    recorder->record(
        book.finish({task.id, 3, tl::unexpected(worker::RequestFailure{"it burnt", false})}).value());
    EXPECT_EQ(wait(job.id, has_ended).row.error, "1 of 1 sectors failed; sector (0, 0): it burnt");
    EXPECT_EQ(sector(job.id, {0, 0}).row.failed_attempts, 3);
    EXPECT_EQ(cache.counts()->results, 0);
}

// What the database says is checked.
TEST_F(RecorderTest, ARestartBakesSectorsOfDamagedRowsAgain) {
    const JobRow job = add({{0, 0}, {1, 0}, {2, 0}});
    for (int n = 0; n < 2; ++n)
        recorder->record(bake_next());
    wait(job.id, [](const JobView& view) { return view.row.sectors_done == 2; });
    recorder->stop();
    change("UPDATE job_sector SET file = '" + to_hex(digest_of("wrong")) + "' WHERE i = 1");
    JobBook after;
    ASSERT_TRUE(load_jobs(*database, after));
    EXPECT_EQ(after.view(job.id)->row.sectors_done, 1);
    EXPECT_EQ(after.next(executor::Priority::interactive)->request.sector, (map::SectorCoordinate{1, 0}));
    EXPECT_EQ(after.next(executor::Priority::interactive)->request.sector, (map::SectorCoordinate{2, 0}));
    EXPECT_FALSE(after.next(executor::Priority::interactive));
}

TEST_F(RecorderTest, AJobWhoseRowIsDamagedMeanwhileFailsAndDoesNotHang) {
    const JobRow job = add({{0, 0}, {1, 0}});
    change("UPDATE job SET setting_bounces = 1");
    recorder->record(bake_next());
    EXPECT_NE(wait(job.id, has_ended).row.error.find("damaged"), std::string::npos);
    EXPECT_FALSE(book.next(executor::Priority::interactive));
}

TEST_F(RecorderTest, AnEndIsFinalWhoeverTellsTheBookLast) {
    JobRow job = add({{0, 0}, {1, 0}});
    JobRow cancelled = job;
    cancelled.state = JobState::cancelled;
    book.update(cancelled);
    book.update(job);  // a recorder that wrote before, and tells after
    EXPECT_EQ(book.view(job.id)->row.state, JobState::cancelled);
}

TEST_F(RecorderTest, ASectorWhoseRowSomebodyElseChangedOrRemovedIsWrittenAllTheSame) {
    const JobRow job = add({{0, 0}, {1, 0}});
    change("UPDATE job_sector SET state = 1 WHERE i = 0");
    change("DELETE FROM job_sector WHERE i = 1");
    recorder->record(bake_next());
    recorder->record(bake_next());
    EXPECT_EQ(wait(job.id, has_ended).row.state, JobState::succeeded);
    EXPECT_TRUE(sector(job.id, {0, 0}).sound);
    EXPECT_EQ(sector(job.id, {1, 0}).row.file, digest_of("file 2"));
}

TEST_F(RecorderTest, ARestartFailsAJobOfWhichASectorIsMissing) {
    const JobRow job = add({{0, 0}, {1, 0}});
    change("DELETE FROM job_sector WHERE i = 1");
    JobBook after;
    ASSERT_TRUE(load_jobs(*database, after));
    EXPECT_EQ(after.view(job.id)->row.state, JobState::failed);
}

TEST_F(RecorderTest, ARestartFailsAJobWhoseSettingsAreDamaged) {
    const JobRow job = add({{0, 0}});
    change("UPDATE job SET setting_bounces = 1");
    JobBook after;
    ASSERT_TRUE(load_jobs(*database, after));
    EXPECT_EQ(after.view(job.id)->row.state, JobState::failed);
    EXPECT_NE(after.view(job.id)->row.error.find("damaged"), std::string::npos);
    EXPECT_FALSE(after.next(executor::Priority::interactive));
}

}  // namespace
}  // namespace drtv::farm
