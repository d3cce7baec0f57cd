// A cluster that does what a test says: faults that a real one has once in a while happen at will. The rest
// is real: the arrays' files, the answers and the blobs stand in a store.
#pragma once

#include "bakerd/executor/cluster.h"
#include "bakerd/worker/array_file.h"
#include "bakerd/worker/requests.h"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace drtv::test {

using executor::ClusterArray;
using executor::ClusterTask;
using executor::ClusterView;
using executor::Refusal;
using executor::TaskState;

class ScriptedCluster final : public executor::Cluster {
  public:
    // Four nodes of two threads, 8 GiB each.
    ScriptedCluster();

    tl::expected<void, Refusal> submit(const ClusterArray& array) override;
    tl::expected<std::vector<ClusterTask>, std::string> list(std::span<const std::string> keys) override;
    tl::expected<ClusterView, std::string> view() override { return cluster; }
    void mend(const ClusterView&) override {}
    void cancel(const std::string& key) override { cancelled.push_back(key); }
    void cancel(std::span<const ClusterTask> tasks) override;
    void nudge(std::span<const ClusterTask> tasks) override;

    // Of the array submitted last, unless said otherwise.
    void set(std::size_t number, TaskState state, int exit_status = 0);
    void set_all(TaskState state, int exit_status = 0);
    [[nodiscard]] std::vector<worker::BakeRequest> batch(std::size_t number) const;
    void forget_all() { tasks.clear(); }

    ClusterView cluster;
    std::optional<Refusal> refusal;    // of the next arrays
    bool takes_refused = false;        // an array that it refuses is taken all the same
    bool is_silent = false;            // lists fail
    std::vector<ClusterArray> arrays;  // all that were submitted
    std::map<std::pair<std::string, std::size_t>, ClusterTask> tasks;
    std::vector<std::string> cancelled;
    std::vector<std::string> cancelled_tasks;
    std::vector<std::string> nudged;
    int lists = 0;
};

// The file of an array that was submitted.
[[nodiscard]] std::string file_of(const ClusterArray& array);

}  // namespace drtv::test
