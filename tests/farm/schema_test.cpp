// Files of each earlier schema, as they were left, become files of today's.
#include "bakerd/farm/job_table.h"
#include "bakerd/farm/map_table.h"
#include "bakerd/farm/result_cache.h"
#include "bakerd/farm/result_table.h"
#include "tests/store/temporary_folder.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

namespace drtv::farm {
namespace {

Digest digest_of(const std::string& text) {
    return map::digest_of(test::bytes_of(text));
}

std::string text_of(const std::string& path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

class SchemaTest : public testing::Test {
  protected:
    void write_schema(int version) const {
        const std::string name = "/tests/farm/schemas/schema_" + std::to_string(version) + ".sql";
        const std::string sql = text_of(DRTV_SOURCE_DIR + name);
        ASSERT_FALSE(sql.empty());
        SQLite::Database(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec(sql);
    }
    [[nodiscard]] std::unique_ptr<Database> open() const {
        auto opened = Database::open(path);
        EXPECT_TRUE(opened) << opened.error().message;
        return std::move(*opened);
    }
    template <class Work>
    static auto read(Database& database, Work work) {
        return database.read(work).value();
    }

    test::TemporaryFolder folder;
    const std::string path = folder.path() + "/farm.sqlite";
};

class FirstSchemas : public SchemaTest, public testing::WithParamInterface<int> {};

TEST_P(FirstSchemas, OpenWithAllTheirRows) {
    write_schema(GetParam());
    // Once as it was and once as the first opening left it.
    for (int n = 0; n < 2; ++n) {
        const auto database = open();
        const auto jobs = read(*database, all_jobs);
        ASSERT_EQ(jobs.size(), 1u);
        EXPECT_TRUE(jobs[0].sound);
        const JobRow& job = jobs[0].row;
        EXPECT_EQ(std::tuple(job.id, job.request_id, job.manifest),
                  std::tuple(5, "request", digest_of("map")));
        EXPECT_EQ(job.preset, "draft");
        ASSERT_TRUE(job.region);
        EXPECT_EQ(std::tuple(job.region->x0, job.region->y1), std::tuple(0, 1));
        EXPECT_EQ(job.state, JobState::running);
        EXPECT_EQ(std::tuple(job.sectors_total, job.sectors_done, job.sectors_failed, job.probes),
                  std::tuple(2, 1, 0, 10));
        EXPECT_EQ(std::tuple(job.sectors_cached, job.created_ms, job.ended_ms), std::tuple(4, 1000000, 0));
        // What still waits is baked under the key of its settings: they must be those that it was asked with.
        settings::JobSettings asked;
        asked.bake.rays = 99;
        asked.bake.bounces = 2;
        asked.bake.reach_m = 64;
        asked.bake.min_distance_m = 7;
        asked.tolerance = 0;  // there was none
        EXPECT_EQ(job.settings, asked);

        const auto sectors =
            read(*database, [](Connection& connection) { return sectors_of_job(connection, 5); });
        ASSERT_EQ(sectors.size(), 2u);
        EXPECT_TRUE(sectors[0].sound && sectors[1].sound);
        const JobSectorRow& done = sectors[0].row;
        EXPECT_EQ(done.sector, (map::SectorCoordinate{-3, 5}));
        EXPECT_EQ(std::tuple(done.state, done.failed_attempts), std::tuple(SectorState::done, 2));
        EXPECT_EQ(std::tuple(done.file, done.file_bytes, done.probes, done.rays),
                  std::tuple(digest_of("result"), 100, 10, 1LL << 40));
        EXPECT_EQ(done.warnings,
                  GetParam() == 1 ? std::vector<std::string>() : (std::vector<std::string>{"one", "two"}));
        EXPECT_EQ(sectors[1].row.state, SectorState::waiting);
        // Without an inventory it has to be looked at again.
        EXPECT_FALSE(
            read(*database, [](Connection& connection) { return find_map(connection, digest_of("map")); }));
    }
}

INSTANTIATE_TEST_SUITE_P(Versions, FirstSchemas, testing::Values(1, 2));

class LastSchemas : public SchemaTest {
  protected:
    // What is known of the four sectors with the settings of the first job, for a map.
    std::vector<CacheEntry> find(Database& database, const Digest& inventory) {
        auto blobs = store::BlobStore::open(folder.path()).value();
        ResultCache cache(database, *blobs, INT64_MAX);
        const auto rows =
            read(database, [](Connection& connection) { return sectors_of_job(connection, 1); });
        std::vector<map::SectorCoordinate> sectors;
        for (const auto& row : rows) {
            sectors.push_back(row.row.sector);
            // An entry counts while its file is there.
            const std::string hex = to_hex(row.row.file);
            std::filesystem::create_directories(folder.path() + "/objects/" + hex.substr(0, 2));
            test::write_file(folder.path() + "/objects/" + hex.substr(0, 2) + "/" + hex, "");
        }
        CachePin pin(cache);
        const Digest key = map::digest_from_hex(first_key).value();
        return cache.find(sectors, {key, inventory, 1 / 512.0f}, pin).value();
    }
    static constexpr const char* first_key =
        "f48f1ee48dc5a03a3a7056dc2049f7e3f738c9a55fa6d9f7c11831739c2a2f26";
    static Digest inventory_of_job(Database& database, std::int64_t id) {
        return read(database, [&](Connection& connection) { return find_job(connection, id); })
            ->row.inventory;
    }
};

class KeptSchemas : public LastSchemas, public testing::WithParamInterface<int> {};

TEST_P(KeptSchemas, KeepResultsForTheirMapAndThoseThatReusedThem) {
    write_schema(GetParam());
    const auto database = open();
    for (const CacheEntry& entry : find(*database, inventory_of_job(*database, 1))) {
        ASSERT_TRUE(entry.held);
        EXPECT_EQ(entry.bound, 0);
        EXPECT_EQ(entry.warning, "");
    }
    const auto of_other_map = find(*database, inventory_of_job(*database, 2));
    EXPECT_EQ(
        std::ranges::count_if(of_other_map, [](const CacheEntry& entry) { return entry.held.has_value(); }),
        3);
    for (const std::int64_t id : {1, 2, 3}) {
        const auto job = read(*database, [&](Connection& connection) { return find_job(connection, id); });
        ASSERT_TRUE(job && job->sound);
        EXPECT_EQ(std::tuple(job->row.state, job->row.sectors_total, job->row.sectors_done),
                  std::tuple(JobState::succeeded, 4, 4));
        EXPECT_GT(job->row.ended_ms, 1700000000000);
        EXPECT_EQ(job->row.settings.bake.rays, id == 3 ? 65536u : 16u);
        // It has to be looked at again.
        EXPECT_FALSE(
            read(*database, [&](Connection& connection) { return find_map(connection, job->row.manifest); }));
        const auto sectors =
            read(*database, [&](Connection& connection) { return sectors_of_job(connection, id); });
        for (const auto& [sector, sound] : sectors)
            EXPECT_TRUE(sound && sector.origin == SectorOrigin::unknown);
    }
}

INSTANTIATE_TEST_SUITE_P(Versions, KeptSchemas, testing::Values(4, 5, 6, 7, 8, 9));

// A step that sums rows anew must not make a damaged one sound.
TEST_F(SchemaTest, ARowThatWasDamagedStaysSo) {
    write_schema(7);
    SQLite::Database(path, SQLite::OPEN_READWRITE)
        .exec(
            "UPDATE job_sector SET probes = probes + 1 WHERE job = 1 AND i = 0 AND j = 0;"
            "UPDATE result SET rays = rays + 1 WHERE id = 1");
    const auto database = open();
    const auto sectors =
        read(*database, [](Connection& connection) { return sectors_of_job(connection, 1); });
    EXPECT_EQ(std::ranges::count(sectors, false, &Checked<JobSectorRow>::sound), 1);
    const auto results =
        read(*database, [](Connection& connection) { return idle_results(connection, 0, 100); });
    EXPECT_EQ(results.size(), 9u);
    EXPECT_EQ(std::ranges::count(results, false, &Checked<ResultRow>::sound), 1);
}

// Their records are of another kind: they are found no more, and leave the cache in their time.
TEST_F(LastSchemas, ResultsOfTheThirdAreGivenUp) {
    write_schema(3);
    const auto database = open();
    for (const CacheEntry& entry : find(*database, inventory_of_job(*database, 1))) {
        EXPECT_FALSE(entry.held);
        EXPECT_TRUE(entry.candidates.empty());
    }
    auto blobs = store::BlobStore::open(folder.path()).value();
    ResultCache cache(*database, *blobs, INT64_MAX);
    EXPECT_EQ(cache.counts()->results, 9);
}

TEST_F(SchemaTest, ANewerFileIsRefusedAndLeftAlone) {
    SQLite::Database(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec("PRAGMA user_version=999");
    for (int n = 0; n < 2; ++n) {
        const auto opened = Database::open(path);
        ASSERT_FALSE(opened);
        EXPECT_EQ(opened.error().code, store::ErrorCode::failed_precondition);
        EXPECT_NE(opened.error().message.find("999"), std::string::npos) << opened.error().message;
    }
}

TEST_F(SchemaTest, AFileThatIsNoDatabaseOrCannotBeMadeIsASentence) {
    test::write_file(path, std::string(5000, 'x'));
    const auto no_database = Database::open(path);
    ASSERT_FALSE(no_database);
    EXPECT_NE(no_database.error().message.find(path), std::string::npos) << no_database.error().message;
    EXPECT_FALSE(Database::open("/no/such/folder/farm.sqlite"));
}

TEST_F(SchemaTest, ADamagedFileIsRefusedWithARemedy) {
    write_schema(4);
    open().reset();
    {
        std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
        // Pages after the first: where the tables stand.
        for (int page = 1; page < 30; ++page) {
            file.seekp(page * 4096);
            file << std::string(600, '\x5a');
        }
    }
    const auto opened = Database::open(path);
    ASSERT_FALSE(opened);
    EXPECT_NE(opened.error().message.find("damaged"), std::string::npos) << opened.error().message;
}

// Killed at any moment of the migration, the file opens again, whole.
TEST_F(SchemaTest, AMigrationThatIsKilledGoesOnAtTheNextStart) {
    constexpr int sectors = 20000;
    int killed = 0;
    for (int n = 0; n < 12; ++n) {
        for (const char* suffix : {"", "-wal", "-shm"})
            std::filesystem::remove(path + suffix);
        write_schema(4);
        SQLite::Database(path, SQLite::OPEN_READWRITE)
            .exec("WITH RECURSIVE n(k) AS (SELECT 1 UNION ALL SELECT k + 1 FROM n WHERE k < " +
                  std::to_string(sectors) +
                  ") INSERT INTO result SELECT 100 + k, k, 0, settings_key, file, size, probes, rays, "
                  "warnings, "
                  "footprint, inventory, footprint_size, seconds, used, bound FROM result, n WHERE id = 1");
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            const auto opened = Database::open(path);
            ::_exit(opened ? 0 : 1);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5 + 20 * n));
        ::kill(child, SIGKILL);
        int status = 0;
        ::waitpid(child, &status, 0);
        killed += WIFSIGNALED(status) ? 1 : 0;
        const auto database = open();
        ASSERT_TRUE(database);
        auto blobs = store::BlobStore::open(folder.path()).value();
        ResultCache cache(*database, *blobs, INT64_MAX);
        EXPECT_EQ(cache.counts()->results, 9 + sectors);
        EXPECT_EQ(read(*database, all_jobs).size(), 3u);
    }
    EXPECT_GE(killed, 3) << "the migration was too quick for this test";
}

}  // namespace
}  // namespace drtv::farm
