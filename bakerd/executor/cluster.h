// The queue of a cluster. It says where and when tasks run, and never whether their work is done: that is
// what their answers say (worker/answers.h).
#pragma once

#include "bakerd/executor/executor.h"

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::executor {

// Tasks that differ in their number alone, which counts from 0.
struct ClusterArray {
    std::string key;  // its name; no two arrays of one name run at the same time
    std::size_t tasks = 0;
    Priority priority = Priority::interactive;
    int threads = 1;                   // of a task
    std::int64_t memory_bytes = 0;     // likewise; 0: not known
    std::vector<std::string> command;  // of each task
    std::string log_folder;            // for what a task prints: <number>.log
    std::set<std::string> excluded_nodes;
};

// Why an array was perhaps not taken: a command that failed may have had its effect.
struct Refusal {
    std::string sentence;
    bool is_too_large = false;  // fewer tasks may be taken
};

enum class TaskState : std::uint8_t {
    waiting,
    delayed,  // waits, although it could begin
    held,     // waits until somebody lets it go
    running,
    done,       // ended by itself, well or not
    cancelled,  // by somebody
    lost,       // its node is gone, or was taken away
    overtime,
    out_of_memory,
};

// What the queue knows of a task.
struct ClusterTask {
    std::string key;
    std::string job;  // the cluster's number, which it may give again later: never what a task is known by
    std::size_t number = 0;
    TaskState state = TaskState::waiting;
    std::string words;  // for people: the state, and the reason for it
    std::string node;
    int exit_status = 0;  // of one that is done
};

struct ClusterNode {
    std::string name;
    int threads = 0;
    std::int64_t memory_bytes = 0;
    bool is_up = false;  // it bakes, or could
    std::string reason;  // why it is not; empty where nobody said
};

struct ClusterView {
    std::size_t max_tasks = 1000;  // of an array
    int task_threads = 1;
    std::vector<ClusterNode> nodes;
};

// Each function asks the cluster and waits for it, some seconds at most where it does not answer. A failure
// is a sentence, and means "no news".
class Cluster {
  public:
    virtual ~Cluster() = default;

    [[nodiscard]] virtual tl::expected<void, Refusal> submit(const ClusterArray& array) = 0;

    // All tasks of these arrays that the cluster remembers: it forgets those that ended, after a while.
    [[nodiscard]] virtual tl::expected<std::vector<ClusterTask>, std::string> list(
        std::span<const std::string> keys) = 0;

    [[nodiscard]] virtual tl::expected<ClusterView, std::string> view() = 0;

    // Brings back nodes that are out by a fault of the cluster's own, where we may.
    virtual void mend(const ClusterView& view) = 0;

    // All tasks of the array, or some.
    virtual void cancel(const std::string& key) = 0;
    virtual void cancel(std::span<const ClusterTask> tasks) = 0;

    // Lets tasks go that are delayed or held.
    virtual void nudge(std::span<const ClusterTask> tasks) = 0;
};

}  // namespace drtv::executor
