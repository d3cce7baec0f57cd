// Writes what has come of sectors: what the database did not take is not done. A thread of its own, so that
// neither the executor nor a caller waits for the disk.
#pragma once

#include "bakerd/farm/database.h"
#include "bakerd/farm/job_book.h"
#include "bakerd/farm/result_cache.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

namespace drtv::farm {

class Recorder {
  public:
    // `work_waits` is called when a sector has to be baked once more. After the database has refused
    // something, it is asked again after `pause`. REQUIRES: all outlive it.
    Recorder(Database& database,
             ResultCache& cache,
             JobBook& book,
             std::function<void()> work_waits,
             std::chrono::milliseconds pause = std::chrono::seconds(1));

    // As stop().
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    void record(FinishedSector sector);

    // Tries what is left once more, and ends. What the database still refuses waits again after a restart.
    void stop();

  private:
    struct Pending {
        FinishedSector sector;
        bool kept = false;  // its result stands in the cache
    };
    // What the database holds of a sector's jobs since it was written.
    struct Written {
        std::vector<JobRow> jobs;
        std::vector<std::int64_t> damaged;
    };

    void run();
    // False: the database did not take it.
    [[nodiscard]] bool try_to_record(Pending& pending);
    // With one wait for the disk. Leaves those that must be tried alone.
    void record_together(std::vector<Pending>& several);
    [[nodiscard]] store::Result<void> write(std::span<Pending> several);
    [[nodiscard]] static Written write_one(Connection& connection, const Pending& pending);
    void tell(Pending& pending, const Written& written);
    // False where jobs joined while the sector was written: it is theirs now.
    [[nodiscard]] bool leave(Pending& pending);
    void refuse(const Pending& pending, const store::Error& error);
    void fail_in_memory(std::int64_t job, const std::string& error);

    Database& database_;
    ResultCache& cache_;
    JobBook& book_;
    const std::function<void()> work_waits_;
    const std::chrono::milliseconds pause_;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Pending> pending_;  // guarded by mutex_
    bool stopping_ = false;        // guarded by mutex_

    std::thread thread_;
};

}  // namespace drtv::farm
