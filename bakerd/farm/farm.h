// The farm: maps, jobs and the sectors they share. Wires the store, the database, the cache, the jobs in
// memory and the executor; no gRPC. Thread-safe.
#pragma once

#include "bakerd/executor/executor.h"
#include "bakerd/farm/data_folder.h"
#include "bakerd/farm/job_book.h"
#include "bakerd/farm/job_request.h"
#include "bakerd/farm/open_executor.h"
#include "bakerd/farm/plan.h"
#include "bakerd/farm/records.h"
#include "bakerd/farm/sector_log.h"
#include "bakerd/farm/sector_views.h"
#include "bakerd/store/blob_store.h"
#include "bakerd/store/error.h"
#include "bakerd/store/manifest.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace drtv::farm {

class Database;
class Maps;
class Planner;
class Recorder;
class ResultCache;

// What a job would do.
struct PlanView {
    Plan plan;
    double seconds = 0;  // that baking it will take; 0: not known
};

struct CacheView {
    CacheCounts counts;
    std::int64_t limit_bytes = 0;
};

class Farm {
  public:
    struct Options {
        std::string data_folder;
        ExecutorOptions executor;
        std::int64_t cache_bytes = std::int64_t{20}
                                   << 30;  // of results; above, the least recently used are evicted
        std::string store_folder{};        // of blobs; empty: within the data folder

        [[nodiscard]] std::string blob_folder() const {
            return (store_folder.empty() ? data_folder : store_folder) + "/blobs";
        }
    };
    // Resumes the state that an earlier run left in the folder.
    [[nodiscard]] static store::Result<std::unique_ptr<Farm>> open(Options options);
    ~Farm();
    Farm(const Farm&) = delete;
    Farm& operator=(const Farm&) = delete;

    [[nodiscard]] store::BlobStore& blobs() { return *blobs_; }

    // Imports and keeps a map whose files are in the store.
    [[nodiscard]] store::Result<MapView> create_map(store::Manifest manifest);
    [[nodiscard]] store::Result<MapView> get_map(const Digest& id);

    // Planning takes a while: no job is made, or it is cancelled, where `is_left` says that its client has
    // gone.
    [[nodiscard]] store::Result<JobView> create_job(
        const JobRequest& request, const std::function<bool()>& is_left = [] { return false; });
    [[nodiscard]] store::Result<PlanView> plan_job(const JobRequest& request);
    [[nodiscard]] store::Result<JobView> get_job(std::int64_t id);
    // Newest first, ids below `before`; of one owner, where it is named.
    [[nodiscard]] store::Result<std::vector<JobView>> list_jobs(std::int64_t before,
                                                                std::size_t count,
                                                                const std::optional<std::string>& owner = {});
    // Before all others of its owner.
    [[nodiscard]] store::Result<JobView> raise_job(std::int64_t id);
    // Begins no more of its sectors, or does again.
    [[nodiscard]] store::Result<JobView> hold_job(std::int64_t id, bool held);
    // With `forget_request` the job is no longer the answer to its request id.
    [[nodiscard]] store::Result<JobView> cancel_job(std::int64_t id, bool forget_request = false);
    // Bakes again what has failed.
    [[nodiscard]] store::Result<JobView> retry_job(std::int64_t id);
    // Waits until the job's version is above `seen` or the time is over.
    [[nodiscard]] store::Result<JobView> wait_for_change(std::int64_t id,
                                                         std::uint64_t seen,
                                                         std::chrono::milliseconds patience);

    // The first `count` in the order of (j, i), behind `after` where it is given.
    [[nodiscard]] store::Result<std::vector<JobSectorView>> list_sectors(
        std::int64_t job, std::optional<map::SectorCoordinate> after, std::int64_t count);
    // In the order asked for; fails when one is not part of the job.
    [[nodiscard]] store::Result<std::vector<JobSectorView>> get_sectors(
        std::int64_t job, const std::vector<map::SectorCoordinate>& sectors);

    // What a cluster's task printed of it.
    [[nodiscard]] store::Result<SectorLog> sector_log(std::int64_t job, map::SectorCoordinate sector);

    [[nodiscard]] store::Result<CacheView> cache();
    // Removes all results that no running job holds; gives what is left.
    [[nodiscard]] store::Result<CacheView> clear_cache();

    // Finishes or puts back the running sectors, at most this long.
    void stop(std::chrono::milliseconds patience);

  private:
    Farm(Options options, std::unique_ptr<DataFolder> folder, std::unique_ptr<store::BlobStore> blobs);
    [[nodiscard]] store::Result<void> load();
    [[nodiscard]] store::Result<void> start();

    [[nodiscard]] store::Result<JobView> create_planned(const JobRequest& request,
                                                        const std::function<bool()>& is_left);
    // Jobs in memory know no warnings of sectors.
    [[nodiscard]] store::Result<JobView> move(std::int64_t id,
                                              const std::function<void(JobRow& job)>& change);
    [[nodiscard]] store::Result<JobView> with_warnings(std::optional<JobView> view, std::int64_t id);

    const Options options_;
    const std::unique_ptr<DataFolder> folder_;
    const std::unique_ptr<store::BlobStore> blobs_;
    std::unique_ptr<Database> database_;
    std::unique_ptr<ResultCache> cache_;
    JobBook book_;
    std::unique_ptr<Recorder> recorder_;
    std::unique_ptr<executor::Executor> executor_;  // its thread calls the above
    std::unique_ptr<Maps> maps_;
    std::unique_ptr<Planner> planner_;
};

}  // namespace drtv::farm
