// In which order the sectors of jobs are baked: interactive jobs before nightly ones; within a priority the
// owners in turn, each by what it has had; the jobs of an owner one after the other, raised ones first. So a
// giant job holds up nobody but its owner. Not thread-safe.
#pragma once

#include "bakerd/executor/executor.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace drtv::farm {

// Where a job stands.
struct QueuePlace {
    std::string owner;
    executor::Priority priority = executor::Priority::interactive;
    std::int64_t raised = 0;  // before the jobs of its owner that are less so
    bool is_held = false;     // none of its sectors is given out
};

class JobQueue {
  public:
    // How much more than others an owner may have had before its turn ends, in seconds of one thread: who
    // changes maps with each sector loads them again and again.
    void set_turn(double seconds) { turn_s_ = seconds; }

    // A new job, or a new place for a known one.
    void put(std::int64_t job, QueuePlace place);
    void remove(std::int64_t job);

    // Something to do for a job that was put, behind all that it has.
    void push(std::int64_t job, std::uint64_t task);

    // The task whose turn it is. Of those that `wants` declines nothing more is heard. `seconds` is what the
    // owner is charged for it.
    struct Wanted {
        bool is_wanted = false;
        double seconds = 0;
    };
    using Wants = std::function<Wanted(std::int64_t job, std::uint64_t task)>;
    [[nodiscard]] std::optional<std::uint64_t> next(executor::Priority priority, const Wants& wants);

    // What a task of the job took beyond what was charged for it.
    void charge(std::int64_t job, double seconds);

    // Jobs with tasks whose turn comes before this one's: interactive ones where it is nightly, and those of
    // its owner that stand before it. And how many owners, its own included, take turns.
    struct Line {
        std::vector<std::int64_t> before;
        std::size_t owners = 1;
    };
    [[nodiscard]] Line line_before(std::int64_t job) const;

  private:
    // Smaller ones first.
    using Rank = std::pair<std::int64_t, std::int64_t>;  // less what it is raised, its number
    struct Owner {
        std::map<Rank, std::deque<std::uint64_t>> jobs;  // that are not held
        double had_s = 0;
        bool is_waiting = false;  // there was something to do for it when it was looked at last
    };
    using Owners = std::map<std::string, Owner>;
    struct Job {
        QueuePlace place;
        std::deque<std::uint64_t> held;  // its tasks while it is held
    };

    [[nodiscard]] static Rank rank_of(std::int64_t job, const QueuePlace& place);
    [[nodiscard]] Owners& owners_of(executor::Priority priority) {
        return owners_[static_cast<std::size_t>(priority)];
    }
    [[nodiscard]] const Owners& owners_of(executor::Priority priority) const {
        return owners_[static_cast<std::size_t>(priority)];
    }
    [[nodiscard]] std::deque<std::uint64_t>& tasks_of(std::int64_t job, Job& known);
    // Its tasks; it stands nowhere then.
    [[nodiscard]] std::deque<std::uint64_t> take_out(std::int64_t job, Job& known);
    [[nodiscard]] static bool has_tasks(const Owner& owner);
    void begin_turn(Owners& owners);

    [[nodiscard]] Owners::iterator next_owner(Owners& owners, const std::string& last) const;

    std::map<std::int64_t, Job> jobs_;
    std::array<Owners, 2> owners_;     // by priority
    std::array<std::string, 2> last_;  // likewise: whose turn it was
    double turn_s_ = 0;
};

}  // namespace drtv::farm
