// A database with jobs and results, for tests of what stands on it.
#pragma once

#include "bakerd/farm/job_table.h"
#include "bakerd/farm/result_cache.h"
#include "tests/store/temporary_folder.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace drtv::farm {

inline Digest digest_of(const std::string& text) {
    return map::digest_of(test::bytes_of(text));
}

inline JobSectorRow sector_row(std::int64_t job, map::SectorCoordinate sector,
                               SectorState state = SectorState::waiting) {
    JobSectorRow row;
    row.job = job;
    row.sector = sector;
    row.state = state;
    return row;
}

class BooksTest : public testing::Test {
  protected:
    BooksTest() : blobs(store::BlobStore::open(folder.path()).value()) { reopen(); }

    void reopen() {
        database.reset();
        auto opened = Database::open(path, std::chrono::milliseconds(50));
        ASSERT_TRUE(opened) << opened.error().message;
        database = std::move(*opened);
    }
    void write(const std::function<void(Connection&)>& work) {
        const auto done = database->write(work);
        ASSERT_TRUE(done) << done.error().message;
    }
    template <class Work>
    auto read(Work work) {
        return database->read(work).value();
    }
    // As another program would.
    void change(const std::string& sql) {
        SQLite::Database other(path, SQLite::OPEN_READWRITE);
        ASSERT_EQ(other.exec(sql), 1) << sql;
    }

    // Runs, with these sectors waiting.
    JobRow add_job(const std::vector<map::SectorCoordinate>& sectors, const std::string& request_id = "") {
        JobRow job;
        job.request_id = request_id;
        job.manifest = digest_of("map");
        job.inventory = digest_of("inventory");
        job.preset = "draft";
        job.settings.bake.rays = 99;
        job.settings.bake.reach_m = 0.3f;
        job.region = JobRegion{0, -1.5, 0.1, 1};
        job.created_ms = 1000;
        write([&](Connection& connection) {
            insert_job(connection, job);
            for (const map::SectorCoordinate& sector : sectors)
                insert_sectors(connection, std::vector{sector_row(job.id, sector)});
            job.state = JobState::running;
            job.sectors_total = static_cast<std::int64_t>(sectors.size());
            update_job(connection, job);
        });
        return job;
    }
    Checked<JobRow> job(std::int64_t id) {
        return read([&](Connection& connection) { return find_job(connection, id); }).value();
    }
    Checked<JobSectorRow> sector(std::int64_t id, map::SectorCoordinate at) {
        return read([&](Connection& connection) { return sector_of_job(connection, id, at); }).value();
    }

    // With its blobs in the store.
    worker::SectorResult result(const std::string& file) {
        worker::SectorResult made;
        made.blobs = {put(file), put(file + " footprint"), put("inventory")};
        made.file_bytes = 100;
        made.footprint_bytes = 20;
        made.probes = 10;
        made.rays = 1LL << 40;
        made.warnings = {"one", "50 % of its rays, say 'no' to \"quotes\"; DROP TABLE job"};
        made.seconds = 1.5;
        made.numbers = {9, 8, 7, 6, 5, 4, 0.1, 0.2, 0.3, 3};
        made.stages = {0.1, 0.2, 0.3, 0.4, 0.5};
        return made;
    }
    Digest put(const std::string& text) { return blobs->put(test::bytes_of(text)).value(); }

    test::TemporaryFolder folder;
    const std::string path = folder.path() + "/farm.sqlite";
    std::unique_ptr<store::BlobStore> blobs;
    std::unique_ptr<Database> database;
};

}  // namespace drtv::farm
