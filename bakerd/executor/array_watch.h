// What has become of the tasks of one array, as answers and the queue tell it.
#pragma once

#include "bakerd/executor/cluster.h"

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace drtv::executor {

using worker::Digest;

// How long news may be late.
struct Patience {
    // A command that failed may have its effect, and a queue forgets what it has lost: longer than Slurm's
    // MessageTimeout and the time between two saves of its state.
    std::chrono::milliseconds silence = std::chrono::seconds(12);
    // An answer may be seen after its task's end; of a task that ended well there is one, and over NFS a
    // folder may look for a minute as it was (acdirmax in nfs(5)).
    std::chrono::milliseconds answer = std::chrono::seconds(3);
    std::chrono::milliseconds sure_answer = std::chrono::seconds(65);
};

// A task that will not answer any more.
struct EndedTask {
    std::vector<Digest> unanswered;
    std::size_t sectors = 0;          // of its batch
    std::optional<ClusterTask> last;  // what the queue said of it; nothing where it knows no such task
};

class ArrayWatch {
  public:
    using Time = std::chrono::steady_clock::time_point;

    // `batches` are the keys of the answers, by task.
    ArrayWatch(const std::vector<std::vector<Digest>>& batches, Patience patience, Time now);

    // Whether the task may still answer it.
    [[nodiscard]] bool expects(std::size_t task, const Digest& answer) const;

    // Nor any other that is in its batch.
    [[nodiscard]] bool is_settled(std::size_t task) const { return tasks_.at(task).unanswered.empty(); }

    // It has its answer, or nobody wants it any more.
    void settle(std::size_t task, const Digest& answer);

    // The queue's list of the array's tasks.
    void hear(std::span<const ClusterTask> tasks, Time now);

    // Each task once: after a list, those that ended, or that the queue has not known for long.
    [[nodiscard]] std::vector<EndedTask> take_ended(Time now);

    // No task is expected to answer any more.
    [[nodiscard]] bool is_over() const;
    // The queue has shown it.
    [[nodiscard]] bool is_known() const { return is_known_; }
    // Tasks that the cluster has put into its queue again since the last call.
    [[nodiscard]] std::size_t take_requeued() { return std::exchange(requeued_, 0); }
    // Those that the queue called alive in its last list. Of one that is not at work `node` is where it was.
    [[nodiscard]] std::vector<ClusterTask> alive() const;
    // Of the living, those that had no sector left to answer in two lists, each once: nothing ends them but
    // we.
    [[nodiscard]] std::vector<ClusterTask> take_idle();

  private:
    struct Task {
        std::vector<Digest> unanswered;  // in the order of baking
        std::size_t sectors = 0;
        Time heard;                 // last time that it was alive
        std::optional<Time> ended;  // when the queue first said so
        std::optional<ClusterTask> last;
        std::string node;    // on which it was seen at work last
        int idle_lists = 0;  // in a row, in which it was alive with nothing to do
        bool is_alive = false;
        bool is_running = false;
        bool is_taken = false;
    };

    [[nodiscard]] std::chrono::milliseconds patience_for(const ClusterTask& ended) const;

    Patience patience_;
    std::vector<Task> tasks_;
    bool is_known_ = false;
    std::size_t requeued_ = 0;
};

}  // namespace drtv::executor
