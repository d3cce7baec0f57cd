#include "bakerd/farm/database.h"
#include "tests/farm/temporary_folder.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
#include <fstream>

namespace drtv::farm {
namespace {

Digest digest_of(const std::string& text) {
    return map::digest_of(test::bytes_of(text));
}

class DatabaseTest : public testing::Test {
  protected:
    DatabaseTest() : database(std::move(*Database::open(path))) {}

    void reopen() {
        database.reset();
        database = std::move(*Database::open(path));
    }

    JobRow add_job(const std::string& request_id = "") {
        JobRow job;
        job.request_id = request_id;
        job.manifest = digest_of("map");
        job.preset = "draft";
        job.settings.rays = 99;
        job.overrides = R"({"rays":"99"})";
        job.region = "[0,0,1,1]";
        job.sectors_cached = 4;
        job.created_seconds = 1000;
        EXPECT_TRUE(database->insert_job(job));
        return job;
    }

    TaskRow add_task(std::int32_t i, std::int32_t j, TaskState state = TaskState::pending) {
        TaskRow task;
        task.key = digest_of(std::to_string(i) + "," + std::to_string(j));
        task.manifest = digest_of("map");
        task.sector = {i, j};
        task.settings.reach_m = 0.3f;
        task.state = state;
        task.result = {digest_of("result"), 100, 10, 1LL << 40, {"one", "two"}};
        task.error = "it's \"bad\"";
        task.failed_attempts = 2;
        EXPECT_TRUE(database->insert_task(task));
        return task;
    }

    test::TemporaryFolder folder;
    const std::string path = folder.path() + "/farm.sqlite";
    std::unique_ptr<Database> database;
};

TEST_F(DatabaseTest, AReopenedFileHasAllOfIt) {
    JobRow job = add_job("request"), other = add_job();
    const TaskRow task = add_task(-3, 5, TaskState::failed);
    EXPECT_GT(other.id, job.id);
    ASSERT_TRUE(database->add_job_task(job.id, task.id));
    ASSERT_TRUE(database->put_map(
        digest_of("map"), {digest_of("content"), digest_of("inventory"), {{1, 2}}, 3, 4, {"warned"}}));
    job.state = JobState::failed;
    job.error = "reason";
    job.ended_seconds = 2000;
    ASSERT_TRUE(database->update_job(job));
    reopen();

    const auto jobs = database->jobs().value();
    ASSERT_EQ(jobs.size(), 2u);
    EXPECT_EQ(jobs[0].id, job.id);
    EXPECT_EQ(jobs[0].request_id, "request");
    EXPECT_EQ(jobs[0].manifest, job.manifest);
    EXPECT_EQ(jobs[0].preset, "draft");
    EXPECT_EQ(jobs[0].settings, job.settings);
    EXPECT_EQ(jobs[0].overrides, job.overrides);
    EXPECT_EQ(jobs[0].region, job.region);
    EXPECT_EQ(jobs[0].state, JobState::failed);
    EXPECT_EQ(jobs[0].error, "reason");
    EXPECT_EQ(std::tuple(jobs[0].sectors_cached, jobs[0].created_seconds, jobs[0].ended_seconds),
              std::tuple(4, 1000, 2000));
    EXPECT_EQ(jobs[1].request_id, "");

    const auto read = database->task_by_key(task.key).value();
    ASSERT_TRUE(read);
    EXPECT_EQ(read->id, task.id);
    EXPECT_EQ(read->manifest, task.manifest);
    EXPECT_EQ(read->sector, task.sector);
    EXPECT_EQ(read->settings, task.settings);
    EXPECT_EQ(read->state, TaskState::failed);
    EXPECT_EQ(read->failed_attempts, 2);
    EXPECT_EQ(read->result.result, task.result.result);
    EXPECT_EQ(std::tuple(read->result.size_bytes, read->result.probes, read->result.rays),
              std::tuple(100, 10, 1LL << 40));
    EXPECT_EQ(read->result.warnings, task.result.warnings);
    EXPECT_EQ(read->error, task.error);

    const auto summary = database->map(digest_of("map")).value();
    ASSERT_TRUE(summary);
    EXPECT_EQ(summary->content, digest_of("content"));
    EXPECT_EQ(summary->warnings, std::vector<std::string>{"warned"});
    EXPECT_FALSE(database->map(digest_of("other map")).value());
    EXPECT_FALSE(database->task_by_key(digest_of("other key")).value());
}

TEST_F(DatabaseTest, TasksOfAJobComeByRowThenColumnInPages) {
    const JobRow job = add_job(), other = add_job();
    for (std::int32_t n = 0; n < 9; ++n) {
        const TaskRow task = add_task(1 - n % 3, 1 - n / 3, n < 5 ? TaskState::done : TaskState::failed);
        ASSERT_TRUE(database->add_job_task(job.id, task.id));
        if (n == 0) {
            ASSERT_TRUE(database->add_job_task(other.id, task.id));
        }
    }
    std::vector<map::SectorCoordinate> seen;
    for (std::int64_t first = 0; first < 12; first += 4) {
        const std::vector<TaskRow> page = database->job_tasks(job.id, first, 4).value();
        for (const TaskRow& task : page)
            seen.push_back(task.sector);
    }
    EXPECT_EQ(seen, (std::vector<map::SectorCoordinate>{
                        {-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {0, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}));
    EXPECT_TRUE(database->job_tasks(job.id, INT64_MAX, 4).value().empty());
    const JobCounts counts = database->job_counts(job.id).value();
    EXPECT_EQ(std::tuple(counts.total, counts.done, counts.failed, counts.probes), std::tuple(9, 5, 4, 90));
    EXPECT_EQ(database->job_counts(other.id)->total, 1);
    EXPECT_EQ(database->job_counts(77)->total, 0);
    EXPECT_TRUE(database->job_task(job.id, {0, 0}).value());
    EXPECT_FALSE(database->job_task(other.id, {0, 0}).value());
}

TEST_F(DatabaseTest, WarningsFollowTheirTask) {
    TaskRow none = add_task(0, 0);
    none.result.warnings.clear();
    ASSERT_TRUE(database->update_task(none));
    TaskRow task = add_task(1, 0);
    task.result.warnings = {"50 % of its rays, say 'no' to \"quotes\"; DROP TABLE task"};
    ASSERT_TRUE(database->update_task(task));
    reopen();
    EXPECT_TRUE(database->task_by_key(none.key).value()->result.warnings.empty());
    EXPECT_EQ(database->task_by_key(task.key).value()->result.warnings, task.result.warnings);
}

TEST_F(DatabaseTest, WarningsOfAJobComeByRowThenColumn) {
    const JobRow job = add_job(), other = add_job();
    const auto add = [&](std::int32_t i, std::int32_t j, std::vector<std::string> warnings) {
        TaskRow task = add_task(i, j, TaskState::done);
        task.result.warnings = std::move(warnings);
        EXPECT_TRUE(database->update_task(task));
        return task.id;
    };
    for (const std::int64_t task : {add(5, 1, {"f"}), add(-2, 0, {"b", "c"}), add(7, -1, {"a"}),
                                    add(3, -2, {}), add(4, 0, {"d"}), add(0, 1, {"e"})})
        ASSERT_TRUE(database->add_job_task(job.id, task));
    ASSERT_TRUE(database->add_job_task(other.id, add(0, 0, {"of another job"})));
    using Sentences = std::vector<std::string>;
    EXPECT_EQ(database->job_warnings(job.id, 20).value(), (Sentences{"a", "b", "c", "d", "e", "f"}));
    EXPECT_EQ(database->job_warnings(job.id, 4).value(), (Sentences{"a", "b", "c", "d"}));
    EXPECT_EQ(database->job_warnings(job.id, 2).value(), (Sentences{"a", "b"}));
    EXPECT_EQ(database->job_warnings(job.id, 0).value(), Sentences{});
    EXPECT_EQ(database->job_warnings(other.id, 20).value(), Sentences{"of another job"});
    EXPECT_EQ(database->job_warnings(77, 20).value(), Sentences{});
}

TEST_F(DatabaseTest, ATransactionThatFailsLeavesNothing) {
    const auto failed = database->transaction([&]() -> Result<void> {
        add_job();
        add_task(0, 0);
        return fail(ErrorCode::aborted, "changed my mind");
    });
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "changed my mind");
    EXPECT_TRUE(database->jobs()->empty());
    EXPECT_FALSE(database->task_by_key(digest_of("0,0")).value());
    // And the next one works.
    EXPECT_TRUE(database->transaction([&]() -> Result<void> { return add_job(), Result<void>(); }));
    reopen();
    EXPECT_EQ(database->jobs()->size(), 1u);
}

TEST_F(DatabaseTest, ARequestIdNamesOneJob) {
    add_job("same");
    add_job();
    add_job();
    JobRow second;
    second.request_id = "same";
    const auto inserted = database->insert_job(second);
    ASSERT_FALSE(inserted);
    EXPECT_NE(inserted.error().message.find("UNIQUE"), std::string::npos) << inserted.error().message;
    EXPECT_EQ(database->jobs()->size(), 3u);
}

TEST_F(DatabaseTest, AKeyNamesOneTask) {
    add_task(1, 1);
    TaskRow second;
    second.key = digest_of("1,1");
    EXPECT_FALSE(database->insert_task(second));
}

class ResultsTest : public DatabaseTest {
  protected:
    ResultRow add_result(map::SectorCoordinate sector, const std::string& file) {
        ResultRow row{0,
                      sector,
                      digest_of("settings"),
                      {digest_of(file),
                       100,
                       10,
                       1000,
                       {"one", "two"},
                       digest_of(file + " footprint"),
                       digest_of("inventory"),
                       20,
                       1.5,
                       0.25f}};
        EXPECT_TRUE(database->insert_result(row));
        return row;
    }
    std::vector<Digest> files(map::SectorCoordinate sector) {
        std::vector<Digest> found;
        const std::vector<ResultRow> rows = database->results(sector, digest_of("settings"), 10).value();
        for (const ResultRow& row : rows)
            found.push_back(row.result.result);
        return found;
    }
};

TEST_F(ResultsTest, ComeTheOneUsedLastFirst) {
    add_result({1, -2}, "a");
    add_result({1, -2}, "b");
    add_result({2, -2}, "c");
    EXPECT_EQ(files({1, -2}), (std::vector<Digest>{digest_of("b"), digest_of("a")}));
    ASSERT_TRUE(database->mark_used({1, -2}, digest_of("a")));
    reopen();
    EXPECT_EQ(files({1, -2}), (std::vector<Digest>{digest_of("a"), digest_of("b")}));
    EXPECT_TRUE(database->results({1, -2}, digest_of("other settings"), 10)->empty());
    const ResultRow row = database->results({1, -2}, digest_of("settings"), 1).value().at(0);
    EXPECT_EQ(std::tuple(row.result.size_bytes, row.result.probes, row.result.rays,
                         row.result.footprint_bytes, row.result.seconds),
              std::tuple(100, 10, 1000, 20, 1.5));
    EXPECT_EQ(row.result.warnings, (std::vector<std::string>{"one", "two"}));
    EXPECT_EQ(std::tuple(row.result.footprint, row.result.inventory),
              std::tuple(digest_of("a footprint"), digest_of("inventory")));
}

TEST_F(ResultsTest, WhatARunningJobHoldsIsNotIdle) {
    const ResultRow held = add_result({0, 0}, "held"), idle = add_result({0, 1}, "idle");
    TaskRow task = add_task(0, 0, TaskState::done);
    task.result.result = digest_of("held");
    ASSERT_TRUE(database->update_task(task));
    JobRow job = add_job();
    ASSERT_TRUE(database->add_job_task(job.id, task.id));
    auto rows = database->idle_results(10).value();
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].id, idle.id);
    ASSERT_TRUE(database->remove_result(held.id));
    EXPECT_TRUE(database->is_needed(digest_of("held")).value()) << "the job has it";
    job.state = JobState::succeeded;
    ASSERT_TRUE(database->update_job(job));
    EXPECT_FALSE(database->is_needed(digest_of("held")).value());
    EXPECT_TRUE(database->is_needed(digest_of("inventory")).value()) << "the other result has it";
    EXPECT_TRUE(database->is_needed(digest_of("idle footprint")).value());
    ASSERT_TRUE(database->remove_result(idle.id));
    EXPECT_FALSE(database->is_needed(digest_of("inventory")).value());
}

TEST_F(ResultsTest, AreCounted) {
    EXPECT_EQ(database->mean_seconds(digest_of("settings")).value(), 0);
    add_result({0, 0}, "a");
    add_result({0, 1}, "b");
    ASSERT_TRUE(database->count(3, 2, 1));
    ASSERT_TRUE(database->count(1, 0, 0));
    const CacheCounts counts = database->cache_counts().value();
    EXPECT_EQ(std::tuple(counts.results, counts.bytes, counts.hits, counts.near_hits, counts.baked),
              std::tuple(2, 240, 4, 2, 1));
    EXPECT_EQ(database->mean_seconds(digest_of("settings")).value(), 1.5);
    EXPECT_EQ(database->mean_seconds(digest_of("never asked for")).value(), 1.5);
}

TEST_F(DatabaseTest, BoundsComeBack) {
    JobRow job = add_job();
    TaskRow task = add_task(0, 0, TaskState::done);
    task.bound = 0.25f;
    ASSERT_TRUE(database->update_task(task));
    EXPECT_EQ(database->task_by_key(task.key).value()->bound, 0.25f);
    JobRow near;
    near.sectors_near = 7;
    near.largest_bound = 0.5f;
    ASSERT_TRUE(database->insert_job(near));
    EXPECT_EQ(database->jobs().value().at(1).sectors_near, 7);
    EXPECT_EQ(database->jobs().value().at(1).largest_bound, 0.5f);
}

TEST_F(DatabaseTest, ANewerSchemaIsRefusedAndLeftAlone) {
    database.reset();
    sqlite3* handle = nullptr;
    ASSERT_EQ(sqlite3_open(path.c_str(), &handle), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(handle, "PRAGMA user_version=999", nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(handle);
    for (int n = 0; n < 2; ++n) {
        const auto opened = Database::open(path);
        ASSERT_FALSE(opened);
        EXPECT_EQ(opened.error().code, ErrorCode::failed_precondition);
        EXPECT_NE(opened.error().message.find("999"), std::string::npos) << opened.error().message;
    }
}

// Records of results were of another kind before the fourth schema: those of the third are no candidates any
// more.
TEST_F(ResultsTest, OfTheThirdSchemaAreGivenUp) {
    add_result({1, 2}, "old");
    database.reset();
    sqlite3* handle = nullptr;
    ASSERT_EQ(sqlite3_open(path.c_str(), &handle), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(handle, "ALTER TABLE result DROP COLUMN bound; PRAGMA user_version=3", nullptr,
                           nullptr, nullptr),
              SQLITE_OK)
        << sqlite3_errmsg(handle);
    sqlite3_close(handle);
    reopen();
    EXPECT_TRUE(database->results({1, 2}, digest_of("settings"), 8)->empty());
    add_result({1, 2}, "new");
    const auto rows = database->results({1, 2}, digest_of("settings"), 8).value();
    // But they are counted, and leave in their turn.
    EXPECT_EQ(database->cache_counts()->results, 2);
    ASSERT_EQ(database->idle_results(8)->size(), 2u);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(std::tuple(rows[0].result.result, rows[0].result.seconds, rows[0].result.bound),
              std::tuple(digest_of("new"), 1.5, 0.25f));
}

// A file as the first schema left it: no warnings, and settings of four values.
class FirstSchema : public DatabaseTest {
  protected:
    FirstSchema() {
        database.reset();
        std::filesystem::remove(path);
        execute(R"sql(
PRAGMA journal_mode=WAL;
CREATE TABLE map (manifest TEXT PRIMARY KEY, summary TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE job (
  id INTEGER PRIMARY KEY AUTOINCREMENT, request_id TEXT UNIQUE, manifest TEXT NOT NULL, preset TEXT NOT NULL,
  settings TEXT NOT NULL, overrides TEXT NOT NULL, region TEXT NOT NULL, state INTEGER NOT NULL, error TEXT NOT NULL,
  sectors_cached INTEGER NOT NULL, created INTEGER NOT NULL, ended INTEGER NOT NULL);
CREATE TABLE task (
  id INTEGER PRIMARY KEY, key TEXT UNIQUE NOT NULL, manifest TEXT NOT NULL, i INTEGER NOT NULL, j INTEGER NOT NULL,
  settings TEXT NOT NULL, state INTEGER NOT NULL, failed_attempts INTEGER NOT NULL, result TEXT NOT NULL,
  size INTEGER NOT NULL, probes INTEGER NOT NULL, rays INTEGER NOT NULL, error TEXT NOT NULL);
CREATE TABLE job_task (job INTEGER NOT NULL, task INTEGER NOT NULL, PRIMARY KEY (job, task)) WITHOUT ROWID;
PRAGMA user_version=1;
)sql");
        const std::string map = to_hex(digest_of("map")),
                          settings = R"({"bounces":2,"min_distance":7.0,"rays":99,"reach":64.0})";
        execute("INSERT INTO map VALUES ('" + map + R"(', '{"id":0,"content":")" +
                to_hex(digest_of("content")) +
                R"(","objects":3,"sectors":[[1,2]],"triangles":4,"warnings":["warned"]}'))");
        execute("INSERT INTO job VALUES (5, 'request', '" + map + "', 'draft', '" + settings +
                R"(', '{"rays":"99"}', '[0,0,1,1]', 0, '', 4, 1000, 0))");
        execute("INSERT INTO task VALUES (8, '" + to_hex(digest_of("baked")) + "', '" + map + "', -3, 5, '" +
                settings + "', 1, 2, '" + to_hex(digest_of("result")) + "', 100, 10, 1099511627776, '')");
        execute("INSERT INTO task VALUES (9, '" + to_hex(digest_of("waiting")) + "', '" + map +
                "', -2, 5, '" + settings + "', 0, 0, '', 0, 0, 0, '')");
        execute("INSERT INTO job_task VALUES (5, 8), (5, 9)");
    }

    void execute(const std::string& sql) const {
        sqlite3* handle = nullptr;
        ASSERT_EQ(sqlite3_open(path.c_str(), &handle), SQLITE_OK);
        EXPECT_EQ(sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
            << sqlite3_errmsg(handle);
        sqlite3_close(handle);
    }
};

TEST_F(FirstSchema, OpensWithAllItsRows) {
    // Once as it was and once as the first opening left it.
    for (int n = 0; n < 2; ++n) {
        reopen();
        const auto jobs = database->jobs().value();
        ASSERT_EQ(jobs.size(), 1u);
        EXPECT_EQ(jobs[0].id, 5);
        EXPECT_EQ(jobs[0].request_id, "request");
        EXPECT_EQ(jobs[0].manifest, digest_of("map"));
        EXPECT_EQ(std::tuple(jobs[0].preset, jobs[0].overrides, jobs[0].region),
                  std::tuple("draft", R"({"rays":"99"})", "[0,0,1,1]"));
        EXPECT_EQ(jobs[0].state, JobState::running);
        EXPECT_EQ(std::tuple(jobs[0].sectors_cached, jobs[0].created_seconds, jobs[0].ended_seconds),
                  std::tuple(4, 1000, 0));

        const auto tasks = database->job_tasks(5).value();
        ASSERT_EQ(tasks.size(), 2u);
        EXPECT_EQ(tasks[0].key, digest_of("baked"));
        EXPECT_EQ(tasks[0].sector, (map::SectorCoordinate{-3, 5}));
        EXPECT_EQ(tasks[0].state, TaskState::done);
        EXPECT_EQ(tasks[0].failed_attempts, 2);
        EXPECT_EQ(tasks[0].result.result, digest_of("result"));
        EXPECT_EQ(std::tuple(tasks[0].result.size_bytes, tasks[0].result.probes, tasks[0].result.rays),
                  std::tuple(100, 10, 1LL << 40));
        EXPECT_TRUE(tasks[0].result.warnings.empty());
        EXPECT_EQ(tasks[1].key, digest_of("waiting"));
        EXPECT_EQ(tasks[1].state, TaskState::pending);
        EXPECT_TRUE(database->job_warnings(5, 20)->empty());
        EXPECT_EQ(database->map(digest_of("map")).value()->warnings, std::vector<std::string>{"warned"});
    }
}

// What still waits is baked under the key of its settings: they must be the ones that it was asked with.
TEST_F(FirstSchema, RowsKeepTheirSettings) {
    reopen();
    bake::Settings asked;
    asked.rays = 99;
    asked.bounces = 2;
    asked.reach_m = 64;
    asked.min_distance_m = 7;
    asked.tolerance = 0;  // there was none
    EXPECT_EQ(database->jobs().value().at(0).settings, asked);
    const auto tasks = database->job_tasks(5).value();
    ASSERT_EQ(tasks.size(), 2u);
    for (const TaskRow& task : tasks)
        EXPECT_EQ(task.settings, asked);
}

TEST_F(FirstSchema, TakesWarningsOnceOpened) {
    reopen();
    TaskRow task = *database->task_by_key(digest_of("waiting")).value();
    task.state = TaskState::done;
    task.result.warnings = {"one", "two"};
    ASSERT_TRUE(database->update_task(task));
    TaskRow fresh = add_task(0, 0);
    reopen();
    EXPECT_EQ(database->task_by_key(digest_of("waiting")).value()->result.warnings,
              (std::vector<std::string>{"one", "two"}));
    EXPECT_EQ(database->task_by_key(fresh.key).value()->result.warnings,
              (std::vector<std::string>{"one", "two"}));
    EXPECT_EQ(database->job_warnings(5, 20).value(), (std::vector<std::string>{"one", "two"}));
}

TEST(Database, AFileThatIsNoDatabaseOrCannotBeMadeIsASentence) {
    const test::TemporaryFolder folder;
    test::write_file(folder.path() + "/text", std::string(5000, 'x'));
    for (const std::string& path :
         {folder.path() + "/text", folder.path() + "/no/such/folder", folder.path()}) {
        const auto opened = Database::open(path);
        ASSERT_FALSE(opened) << path;
        EXPECT_GT(opened.error().message.size(), 20u);
    }
}

}  // namespace
}  // namespace drtv::farm
