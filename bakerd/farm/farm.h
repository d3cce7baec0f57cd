// The farm: maps, jobs and the sectors they share. Knows the store, the database and the executor; no gRPC.
// Thread-safe.
#pragma once

#include "bakerd/farm/blob_store.h"
#include "bakerd/farm/data_folder.h"
#include "bakerd/farm/database.h"
#include "bakerd/farm/error.h"
#include "bakerd/farm/job_request.h"
#include "bakerd/farm/local_executor.h"
#include "bakerd/farm/manifest.h"
#include "bakerd/farm/plan.h"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace drtv::farm {

struct MapView {
    Digest id;
    Manifest manifest;
    InspectAnswer summary;
};

struct JobView {
    JobRow row;
    JobCounts counts;
    std::int64_t rays = 0;  // of sectors baked since the server started
    double rays_per_second = 0, seconds_left = 0;
    std::uint64_t version = 0;  // grows with each change
    std::vector<std::string>
        warnings;  // of records it could not use; once it has ended, of its sectors, the first few
};

// What a job would do.
struct PlanView {
    Plan plan;
    double seconds = 0;  // that baking it will take; 0: not known
};

struct CacheView {
    CacheCounts counts;
    std::int64_t limit_bytes = 0;
};

struct SectorView {
    TaskRow task;
    bool running = false;
};

class Farm {
  public:
    struct Options {
        std::string data_folder;
        std::vector<std::string> worker_command;
        int threads = 1;
        std::int64_t cache_bytes = std::int64_t{20} << 30;  // of results; beyond, those used longest ago go
    };
    // Goes on where an earlier run in the same folder stopped.
    [[nodiscard]] static Result<std::unique_ptr<Farm>> open(Options options);
    ~Farm();
    Farm(const Farm&) = delete;
    Farm& operator=(const Farm&) = delete;

    [[nodiscard]] BlobStore& blobs() { return *blobs_; }

    // Imports and keeps a map whose files are in the store.
    [[nodiscard]] Result<MapView> create_map(Manifest manifest);
    [[nodiscard]] Result<MapView> get_map(const Digest& id);

    [[nodiscard]] Result<JobView> create_job(const JobRequest& request);
    [[nodiscard]] Result<PlanView> plan_job(const JobRequest& request);
    [[nodiscard]] Result<JobView> get_job(std::int64_t id);
    // Newest first, ids below `before`.
    [[nodiscard]] Result<std::vector<JobView>> list_jobs(std::int64_t before, std::size_t count);
    [[nodiscard]] Result<JobView> cancel_job(std::int64_t id);
    // Waits until the job's version is above `seen` or the time is over.
    [[nodiscard]] Result<JobView> wait_for_change(std::int64_t id,
                                                  std::uint64_t seen,
                                                  std::chrono::milliseconds patience);

    // In the order of (j, i).
    [[nodiscard]] Result<std::vector<SectorView>> list_sectors(std::int64_t job,
                                                               std::int64_t first,
                                                               std::int64_t count);
    [[nodiscard]] Result<SectorView> get_sector(std::int64_t job, map::SectorCoordinate sector);

    [[nodiscard]] Result<CacheView> cache();
    // Removes all results that no running job holds; gives what is left.
    [[nodiscard]] Result<CacheView> clear_cache();

    // Finishes or puts back the running sectors, at most this long.
    void stop(std::chrono::milliseconds patience);

  private:
    using Clock = std::chrono::steady_clock;
    struct Job {
        JobRow row;
        JobCounts counts;                  // of running jobs; others ask the database
        std::vector<std::int64_t> tasks;   // of running jobs
        std::int64_t rays = 0, baked = 0;  // since the server started
        std::optional<Clock::time_point> started;
        std::uint64_t version = 1;
        std::vector<std::string> warnings;  // of records that could not be used
    };
    struct Task {
        TaskRow row;
        std::vector<std::int64_t> jobs;  // running jobs that want it
        bool running = false;
        std::optional<BakeAnswer> earlier;  // of which the bake takes over what holds
    };

    Farm(Options options,
         std::unique_ptr<DataFolder> folder,
         std::unique_ptr<BlobStore> blobs,
         std::unique_ptr<Database> database);
    [[nodiscard]] Result<void> load();
    void adopt(Job& job, std::vector<TaskRow> tasks, const std::vector<map::SectorCoordinate>& order);
    void reopen(const Task& task);
    // With the settings and the map's summary. Not under the lock: it waits for the worker.
    struct Planned {
        bake::Settings settings;
        InspectAnswer map;
        Plan plan;
    };
    [[nodiscard]] Result<Planned> make_plan(const JobRequest& request);
    [[nodiscard]] Result<std::vector<TaskRow>> carry_out(JobRow& row,
                                                         const Digest& content,
                                                         const Plan& plan);
    [[nodiscard]] Result<TaskRow> find_or_add_task(const JobRow& job,
                                                   const Digest& content,
                                                   const PlannedSector& planned);
    void keep_result(const TaskRow& task);
    // Removes results, those used longest ago first, until at most so many bytes are left.
    [[nodiscard]] Result<void> shrink_cache(std::int64_t most_bytes);
    [[nodiscard]] Result<CacheView> cache_view();
    [[nodiscard]] std::optional<BakeRequest> next_task();
    void task_finished(std::int64_t id, int failed_attempts, const Outcome& outcome);
    void end_job_if_complete(Job& job);
    void end_job(Job& job, JobState state, std::string error);
    [[nodiscard]] Result<Job*> find_job(std::int64_t id);
    [[nodiscard]] Result<JobView> view_of(const Job& job);
    void changed(Job& job);

    const Options options_;
    const std::unique_ptr<DataFolder> folder_;
    const std::unique_ptr<BlobStore> blobs_;

    std::mutex mutex_;
    std::condition_variable job_changed_;
    const std::unique_ptr<Database> database_;      // guarded by mutex_
    std::map<std::int64_t, Job> jobs_;              // guarded by mutex_
    std::unordered_map<std::int64_t, Task> tasks_;  // guarded by mutex_; of running jobs
    std::int64_t cache_bytes_ = 0;                  // guarded by mutex_; of files and footprints
    std::deque<std::int64_t> waiting_;              // guarded by mutex_; tasks in the order of baking

    std::unique_ptr<LocalExecutor> executor_;  // last: its thread calls the above
};

}  // namespace drtv::farm
