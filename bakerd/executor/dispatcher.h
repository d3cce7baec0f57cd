// Sends sectors to a cluster as arrays of tasks, and takes in their answers. What is true stands in the
// store: an array's file, written before the cluster hears of it, and the answers of its tasks; the queue
// only says what is alive. So the daemon, a task, a node or the queue may die at any moment. Of one thread.
#pragma once

#include "bakerd/executor/array_folder.h"
#include "bakerd/executor/array_watch.h"
#include "bakerd/executor/cluster.h"
#include "bakerd/executor/costs.h"
#include "bakerd/executor/executor.h"
#include "bakerd/store/blob_store.h"
#include "bakerd/worker/answers.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace drtv::executor {

struct DispatchOptions {
    std::string store_folder;
    std::string owner;                      // of the store (store/owner.h)
    std::vector<std::string> task_command;  // what a task runs, but for its array's file
    int differs_status = -1;                // with which it ends on a node that must not bake for the daemon
    double batch_s = 90;                    // that a batch should take
    double max_batch_s = 24 * 3600;         // and may, where the map takes long to load
    // Times between looks.
    std::chrono::milliseconds answers_every = std::chrono::milliseconds(1500);
    std::chrono::milliseconds queue_every = std::chrono::seconds(5);
    std::chrono::milliseconds cluster_every = std::chrono::seconds(60);
    // Before another array, after one that was not taken; twice as long each time, up to 16 times.
    std::chrono::milliseconds pause = std::chrono::seconds(4);
    Patience patience;
    std::function<std::chrono::steady_clock::time_point()> clock = std::chrono::steady_clock::now;
};

// Tasks that had a sector may be lost this often: the tasks', not the sector's fault.
inline constexpr int max_losses = 10;

class Dispatcher {
  public:
    using Time = ArrayWatch::Time;

    // Goes on with the arrays that the owner left in the store.
    [[nodiscard]] static store::Result<Dispatcher> open(DispatchOptions options,
                                                        Cluster& cluster,
                                                        store::BlobStore& blobs,
                                                        Executor::Callbacks callbacks);

    // Does what is due, and says when something will be again.
    [[nodiscard]] Time step();

    // As the last step left it.
    [[nodiscard]] ClusterState state() const;

  private:
    // A task of an array.
    struct Place {
        std::string array;
        std::size_t task = 0;
    };
    struct Sector {
        std::vector<std::uint64_t> ids;  // of the caller
        worker::BakeRequest request;
        Digest kind;  // Costs::kind_of
        Priority priority = Priority::interactive;
        double seconds = 0;
        int failures = 0;            // of tasks that had it
        int losses = 0;              // of tasks that had it, by no fault of theirs
        bool alone = false;          // a task that had it, and others, failed
        std::optional<Place> place;  // nothing: it is ready
    };
    // Sectors that wait for an array.
    struct Ready {
        std::deque<Digest> keys;  // in the order of baking; some may have been given up
        double seconds = 0;       // of one thread, that they take, as far as is known
        std::size_t unknown = 0;  // of which that is not known
        bool is_dry = false;      // nothing waits behind them
    };
    // How arrays of a priority were taken of late.
    struct Submissions {
        Time next;                  // when another may be tried
        int refusals = 0;           // in a row
        std::size_t max_tasks = 0;  // of the next array; 0: what the cluster allows
        std::string trouble;        // why the last one was not taken; empty: it was
    };
    // An answer that was delivered.
    struct Spent {
        Digest answer;
        std::vector<std::uint64_t> ids;  // of the caller
        std::optional<Place> place;
        Time delivered;
    };
    // A node that must not bake.
    struct Exclusion {
        Time until;
        std::string why;
    };
    struct Array {
        Priority priority = Priority::interactive;
        std::vector<std::vector<Digest>> batches;
        ArrayWatch watch;
        std::int64_t memory_bytes = 0;
        bool was_taken = true;                  // the cluster did not refuse it
        bool is_pilot = false;                  // it tells what others cost
        std::map<std::size_t, int> releases{};  // of tasks that were held
    };

    Dispatcher(DispatchOptions options,
               Cluster& cluster,
               store::BlobStore& blobs,
               Executor::Callbacks callbacks,
               ArrayFolder folder,
               worker::Answers answers);
    [[nodiscard]] store::Result<void> load_arrays();
    [[nodiscard]] Time now() const { return options_.clock(); }

    [[nodiscard]] Ready& ready(Priority priority) { return ready_[static_cast<std::size_t>(priority)]; }
    [[nodiscard]] Submissions& submissions(Priority priority) {
        return submissions_[static_cast<std::size_t>(priority)];
    }

    // dispatcher.cpp: sectors and their answers.
    void pull();
    [[nodiscard]] bool is_enough(Priority priority, const Ready& ready, std::size_t sectors) const;
    void count(const Digest& key, Ready& ready) const;
    [[nodiscard]] double cost_of(const Sector& sector) const;
    void take_up(SectorTask task);
    void collect_answers();
    void deliver(const Digest& key, const worker::TaskAnswer& answer);
    void finish(const Digest& key,
                const Reply<worker::SectorResult>& reply,
                const std::string& node = {},
                const std::string& log = {});
    void settle(const Digest& key, Sector& sector);
    void give_up_unwanted();

    // dispatch_arrays.cpp: arrays and the queue.
    void settle_left_behind();
    void ask_queue();
    [[nodiscard]] bool is_to_be_let_go(Array& array, const ClusterTask& task);
    void judge(const std::string& key, Array& array);
    void close_arrays();
    [[nodiscard]] bool is_at_work(const Place& place) const;
    void remove_spent_answers();

    // dispatch_ends.cpp: tasks that ended with sectors to bake.
    [[nodiscard]] bool is_fault_of_node(const EndedTask& ended, const std::string& printed);
    [[nodiscard]] Sector* find_placed(const Digest& key, const std::string& array);
    [[nodiscard]] bool is_missed(const std::string& array, const EndedTask& ended);
    void try_again(const std::string& array_key, const Array& array, const EndedTask& ended);

    // dispatch_view.cpp: the cluster.
    void view_cluster();
    [[nodiscard]] bool may_bake(const ClusterNode& node) const;
    [[nodiscard]] std::size_t slots() const;

    // dispatch_submit.cpp: arrays of what is ready.
    void submit(Priority priority);
    struct Cut {
        std::vector<std::vector<Digest>> batches;
        bool is_pilot = false;
    };
    [[nodiscard]] Cut cut(Priority priority);
    void refuse_all(Priority priority);
    [[nodiscard]] std::size_t tasks_of_array() const;
    [[nodiscard]] double batch_s(Priority priority) const;
    [[nodiscard]] std::int64_t memory_for(std::span<const std::vector<Digest>> batches) const;

    DispatchOptions options_;
    Cluster* cluster_;
    store::BlobStore* blobs_;
    Executor::Callbacks callbacks_;
    ArrayFolder folder_;
    worker::Answers answers_;

    std::map<Digest, Sector> sectors_;  // taken up, by the key of the answer
    std::vector<Digest> fresh_;   // of these, for which no answer has been looked for, in the order of baking
    std::array<Ready, 2> ready_;  // by priority
    std::array<Submissions, 2> submissions_;  // likewise
    std::map<std::string, Array> arrays_;     // that are open
    std::map<Digest, Place> left_behind_;     // in an earlier run's arrays, and not taken up yet
    std::vector<Spent> spent_;
    std::map<std::string, std::set<Digest>> barren_;  // by node: batches that it failed since its last answer
    std::map<std::string, Exclusion> excluded_;       // nodes
    Costs costs_;
    std::optional<ClusterView> view_;
    Time opened_;
    Time viewed_;           // when it was asked for last
    Time shaken_;           // when tasks were lost last
    std::size_t lost_ = 0;  // tasks
    // What the cluster could not do when it was asked last; empty: it could.
    std::string list_trouble_, view_trouble_;
    Time next_answers_, next_queue_, next_view_;
};

}  // namespace drtv::executor
