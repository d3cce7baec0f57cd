// Makes what the farm bakes with.
#pragma once

#include "bakerd/executor/executor.h"
#include "bakerd/executor/slurm.h"
#include "bakerd/store/blob_store.h"
#include "bakerd/store/error.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace drtv::farm {

struct ExecutorOptions {
    std::vector<std::string> worker_command;
    int threads = 1;  // of the worker
    // Where sectors are baked on a cluster; nothing: on this machine.
    std::optional<executor::SlurmOptions> slurm{};
    std::vector<std::string> task_command{};  // what a task of it runs, but for its array
    int differs_status = -1;                  // with which a task ends on a node that must not bake
    double batch_s = 90;                      // that a task should take
};

// How long an owner's turn should last (JobQueue::set_turn): ten seconds of this machine, or a task of the
// cluster.
[[nodiscard]] double turn_s(const ExecutorOptions& options);

// `store_folder` and its `owner` are needed for a cluster.
[[nodiscard]] store::Result<std::unique_ptr<executor::Executor>> open_executor(
    const ExecutorOptions& options,
    const std::string& store_folder,
    const std::string& owner,
    store::BlobStore& blobs,
    executor::Executor::Callbacks callbacks);

}  // namespace drtv::farm
