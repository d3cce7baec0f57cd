// The farm's state in one SQLite file (WAL, synchronous FULL). Not thread-safe: the farm calls it under its
// lock. Losing the file loses jobs, never correctness: it can be rebuilt by submitting again.
#pragma once

#include "bakerd/bake/settings.h"
#include "bakerd/farm/error.h"
#include "bakerd/farm/worker_protocol.h"
#include "bakerd/map/digest.h"
#include "bakerd/map/ground.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct sqlite3;

namespace drtv::farm {

using map::Digest;

enum class TaskState : std::uint8_t { pending = 0, done = 1, failed = 2 };
enum class JobState : std::uint8_t { running = 0, succeeded = 1, failed = 2, cancelled = 3 };

// One sector under one content and settings: what jobs share. Named by its key, so that two jobs that want
// the same sector bake it once.
struct TaskRow {
    std::int64_t id = 0;
    Digest key;
    Digest manifest;  // some map with this content
    map::SectorCoordinate sector;
    bake::Settings settings;
    TaskState state = TaskState::pending;
    int failed_attempts = 0;
    BakeAnswer result;  // when done; without the records it rests on, which stand in ResultRow
    float bound = 0;    // when done with a result of another map: how far it may be off (assessment.h)
    std::string error;  // when failed
};

// A baked sector, kept for this map and any other for which it still holds.
struct ResultRow {
    std::int64_t id = 0;
    map::SectorCoordinate sector;
    Digest results_key;  // reuse::results_key
    BakeAnswer result;
};

// What the cache has done since the database was made.
struct CacheCounts {
    std::int64_t results = 0, bytes = 0;              // kept now: files and footprints
    std::int64_t hits = 0, near_hits = 0, baked = 0;  // sectors of all jobs
};

struct JobRow {
    std::int64_t id = 0;
    std::string request_id;
    Digest manifest;
    std::string preset;
    bake::Settings settings;
    std::string overrides, region;  // as asked, JSON
    JobState state = JobState::running;
    std::string error;
    std::int64_t sectors_cached = 0, sectors_near = 0;  // hits and near hits
    float largest_bound = 0;  // of the near hits, and of probes that others took over
    std::int64_t created_seconds = 0, ended_seconds = 0;  // Unix time
};

struct JobCounts {
    std::int64_t total = 0, done = 0, failed = 0, probes = 0;
};

class Database {
  public:
    // Fails with a sentence when the file cannot be opened or is of a newer version.
    [[nodiscard]] static Result<std::unique_ptr<Database>> open(const std::string& path);
    ~Database();
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    // All of `work` or none of it is kept. Each call is durable when it returns.
    [[nodiscard]] Result<void> transaction(const std::function<Result<void>()>& work);

    [[nodiscard]] Result<void> put_map(const Digest& manifest, const InspectAnswer& summary);
    [[nodiscard]] Result<std::optional<InspectAnswer>> map(const Digest& manifest);

    // Sets `job.id`.
    [[nodiscard]] Result<void> insert_job(JobRow& job);
    [[nodiscard]] Result<void> update_job(const JobRow& job);
    // Ids and rows, oldest first.
    [[nodiscard]] Result<std::vector<JobRow>> jobs();
    [[nodiscard]] Result<void> add_job_task(std::int64_t job, std::int64_t task);
    // Rows `first` to `first + count` of a job's tasks in the order of (j, i).
    [[nodiscard]] Result<std::vector<TaskRow>> job_tasks(std::int64_t job,
                                                         std::int64_t first = 0,
                                                         std::int64_t count = INT64_MAX);
    [[nodiscard]] Result<std::optional<TaskRow>> job_task(std::int64_t job, map::SectorCoordinate sector);
    [[nodiscard]] Result<JobCounts> job_counts(std::int64_t job);
    // The first `most` warnings of a job's sectors, in the order of (j, i).
    [[nodiscard]] Result<std::vector<std::string>> job_warnings(std::int64_t job, std::size_t most);

    [[nodiscard]] Result<void> insert_task(TaskRow& task);
    [[nodiscard]] Result<void> update_task(const TaskRow& task);
    [[nodiscard]] Result<std::optional<TaskRow>> task_by_key(const Digest& key);

    // Sets `row.id`. It counts as the one used last.
    [[nodiscard]] Result<void> insert_result(ResultRow& row);
    // Of one sector, the one used last first.
    [[nodiscard]] Result<std::vector<ResultRow>> results(map::SectorCoordinate sector,
                                                         const Digest& results_key,
                                                         std::size_t most);
    // Of the result with that file.
    [[nodiscard]] Result<void> mark_used(map::SectorCoordinate sector, const Digest& file);
    // Those used longest ago, without any that a running job holds.
    [[nodiscard]] Result<std::vector<ResultRow>> idle_results(std::size_t most);
    [[nodiscard]] Result<void> remove_result(std::int64_t id);
    // Whether a result or a running job has the blob as its file, footprint or inventory.
    [[nodiscard]] Result<bool> is_needed(const Digest& blob);
    // Mean of what sectors took with these settings, or with any when there are none; 0 without results.
    [[nodiscard]] Result<double> mean_seconds(const Digest& results_key);
    [[nodiscard]] Result<void> count(std::int64_t hits, std::int64_t near_hits, std::int64_t baked);
    [[nodiscard]] Result<CacheCounts> cache_counts();

  private:
    class Statement;
    explicit Database(sqlite3* handle) : handle_(handle) {}
    [[nodiscard]] Result<void> execute(const char* sql);
    [[nodiscard]] tl::unexpected<Error> error(const char* doing) const;

    sqlite3* handle_;
};

}  // namespace drtv::farm
