// The jobs in memory, and the sectors that are waiting or at work for them. Knows no database: what is told
// here has been written already, or cannot be, because the database is damaged. Thread-safe.
#pragma once

#include "bakerd/executor/executor.h"
#include "bakerd/farm/job_queue.h"
#include "bakerd/farm/records.h"

#include <chrono>
#include <compare>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace drtv::farm {

struct JobView {
    JobRow row;
    std::int64_t rays = 0;  // of sectors baked since the server started
    double rays_per_second = 0;
    double seconds_left = 0;            // 0: not known
    bool waiting = false;               // none of its sectors has been taken up yet
    std::int64_t jobs_ahead = 0;        // where it waits: whose turn comes before
    double seconds_to_start = 0;        // likewise, about; 0: not known
    std::uint64_t version = 0;          // grows with each change
    std::vector<std::string> warnings;  // of records that could not be used; of the database; the first few
    std::optional<executor::ClusterState> cluster;  // of a running job, where there is one
};

// What makes two jobs want the same bake.
struct BakeKey {
    Digest results_key;  // reuse::results_key
    Digest inventory;    // of the map
    map::SectorCoordinate sector;
    float tolerance = 0;

    auto operator<=>(const BakeKey&) const = default;
};

// A sector that has to be baked.
struct WantedSector {
    map::SectorCoordinate sector;
    std::optional<ResultRow> earlier;  // of which the bake reuses what holds
    double seconds = 0;                // that baking it will take, as far as is known; 0: not
};

// What has come of a sector, for each job that wants it.
struct FinishedSector {
    BakeKey key;
    std::vector<std::int64_t> jobs;
    executor::SectorEnd end;
};

class JobBook {
  public:
    // JobQueue::set_turn. REQUIRES: nothing else is called at the same time.
    void set_turn(double seconds) { queue_.set_turn(seconds); }

    // A job that is known from now on; `wanted` are its sectors that are not there, in the order of baking.
    // One that another job waits for is baked once. `expected_s` is how long they will take; 0: not known.
    void add(JobRow row,
             std::span<const WantedSector> wanted,
             std::vector<std::string> warnings = {},
             double expected_s = 0);

    // A job that had ended, and goes on with these sectors.
    void reopen(const JobRow& row, std::span<const WantedSector> wanted);

    // The job of a request id. While nobody has it, the caller may make one, and others wait; it must call
    // end_request.
    [[nodiscard]] std::optional<std::int64_t> begin_request(const std::string& request_id);
    void end_request(const std::string& request_id);

    // The next sector of this priority to bake; it is at work then.
    [[nodiscard]] std::optional<executor::SectorTask> next(executor::Priority priority);

    // Forgets a sector at work that no job wants any more; false where one does.
    [[nodiscard]] bool give_up(std::uint64_t id);

    // Until its end was recorded, or it was given up.
    [[nodiscard]] bool knows(std::uint64_t id) const;

    // Ends the work on a sector, and says for whom it was done. Jobs may go on joining until all have left.
    [[nodiscard]] std::optional<FinishedSector> finish(executor::SectorEnd end);
    // Of those for whom it was recorded, nobody waits for the sector any more. Gives jobs that joined
    // meanwhile; the task is forgotten where there are none.
    [[nodiscard]] std::vector<std::int64_t> leave(std::uint64_t id, std::span<const std::int64_t> recorded);
    // The sector waits again.
    void put_back(std::uint64_t id);

    // It has another place in the queue, as was written.
    void move(const JobRow& row);

    // What was written of a job. `result` is a sector that was baked for it.
    void update(const JobRow& row, const worker::SectorResult* result = nullptr);
    // Shown with the job from now on.
    void warn(std::int64_t job, const std::string& sentence);

    [[nodiscard]] std::optional<JobView> view(std::int64_t id) const;
    // Newest first, ids below `before`; of one owner, where it is named.
    [[nodiscard]] std::vector<JobView> list(std::int64_t before,
                                            std::size_t count,
                                            const std::optional<std::string>& owner = {}) const;
    // Waits until the job's version is above `seen` or the time is over.
    [[nodiscard]] std::optional<JobView> wait_for_change(std::int64_t id,
                                                         std::uint64_t seen,
                                                         std::chrono::milliseconds patience);
    [[nodiscard]] bool is_running(std::int64_t job, map::SectorCoordinate sector) const;

  private:
    using Clock = std::chrono::steady_clock;
    struct Job {
        JobRow row;
        std::map<map::SectorCoordinate, std::uint64_t> tasks;  // of sectors that are not there yet
        std::int64_t rays = 0;                                 // since the server started
        std::int64_t baked = 0;                                // likewise
        double baked_s = 0;                                    // likewise, of one thread
        std::optional<Clock::time_point> started;
        std::uint64_t version = 1;
        std::vector<std::string> warnings;
        double expected_s = 0;  // that it takes; 0: not known
    };
    struct Task {
        BakeKey key;
        worker::BakeRequest request;
        double earlier_seconds = 0;  // that the earlier result took from nothing; 0: there is none
        double seconds = 0;          // that baking it will take, as far as is known; 0: not
        std::set<std::int64_t> jobs;
        bool running = false;
        std::int64_t charged_job = 0;  // whose turn it was
        double charged_s = 0;          // that its owner was charged with
    };

    [[nodiscard]] static QueuePlace place_of(const JobRow& job) {
        return {job.owner, job.priority, job.raised, job.held};
    }
    // One that is at work may be about to end with what the job has just heard.
    enum class Join : std::uint8_t { any, waiting };
    void want(Job& job, std::span<const WantedSector> wanted, Join join);
    // `key` is the sector's, but for its tolerance.
    [[nodiscard]] std::uint64_t task_for(const Job& job, const WantedSector& wanted, BakeKey key, Join join);
    [[nodiscard]] JobQueue::Wanted begin(std::int64_t turn, std::uint64_t id);
    void drop_tasks(Job& job);
    void forget(std::uint64_t id);
    void changed(Job& job);
    [[nodiscard]] JobView view_of(const Job& job) const;
    void add_wait(JobView& view) const;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::int64_t, Job> jobs_;                // guarded by mutex_
    std::unordered_map<std::uint64_t, Task> tasks_;   // guarded by mutex_
    std::map<BakeKey, std::uint64_t> tasks_by_key_;   // guarded by mutex_
    JobQueue queue_;                                  // guarded by mutex_
    std::map<std::string, std::int64_t> by_request_;  // guarded by mutex_
    std::set<std::string> open_requests_;             // guarded by mutex_
    std::uint64_t next_task_ = 1;                     // guarded by mutex_
};

}  // namespace drtv::farm
