#include "tests/executor/scripted_cluster.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace drtv::test {
namespace {

std::string name_of(const ClusterTask& task) {
    return fmt::format("{} {}", task.key, task.number);
}

}  // namespace

std::string file_of(const ClusterArray& array) {
    const auto option = std::ranges::find(array.command, "--array");
    return option == array.command.end() ? "" : *(option + 1);
}

ScriptedCluster::ScriptedCluster() {
    cluster.max_tasks = 1000;
    cluster.task_threads = 2;
    for (int n = 1; n <= 4; ++n)
        cluster.nodes.push_back({fmt::format("node{}", n), 2, std::int64_t{8} << 30, true, ""});
}

tl::expected<void, Refusal> ScriptedCluster::submit(const ClusterArray& array) {
    if (!refusal || takes_refused) {
        for (std::size_t n = 0; n < array.tasks; ++n)
            tasks[{array.key, n}] = {
                array.key, fmt::format("{}", 100 + arrays.size()), n, TaskState::waiting, "PENDING", "node1",
                0};
    }
    arrays.push_back(array);
    if (refusal)
        return tl::unexpected(*refusal);
    return {};
}

tl::expected<std::vector<ClusterTask>, std::string> ScriptedCluster::list(std::span<const std::string> keys) {
    ++lists;
    if (is_silent)
        return tl::unexpected(std::string("squeue was not done after 20000 ms"));
    std::vector<ClusterTask> listed;
    for (const auto& [name, task] : tasks) {
        if (std::ranges::find(keys, name.first) != keys.end())
            listed.push_back(task);
    }
    return listed;
}

void ScriptedCluster::cancel(std::span<const ClusterTask> some) {
    for (const ClusterTask& task : some)
        cancelled_tasks.push_back(name_of(task));
}

void ScriptedCluster::nudge(std::span<const ClusterTask> some) {
    for (const ClusterTask& task : some)
        nudged.push_back(name_of(task));
}

void ScriptedCluster::set(std::size_t number, TaskState state, int exit_status) {
    ClusterTask& task = tasks.at({arrays.back().key, number});
    task.state = state;
    task.words = "SOME STATE";
    task.exit_status = exit_status;
}

void ScriptedCluster::set_all(TaskState state, int exit_status) {
    for (std::size_t n = 0; n < arrays.back().tasks; ++n)
        set(n, state, exit_status);
}

std::vector<worker::BakeRequest> ScriptedCluster::batch(std::size_t number) const {
    const auto batch = worker::read_batch(file_of(arrays.back()), number);
    if (!batch)
        throw std::runtime_error(batch.error());
    return batch->sectors;
}

}  // namespace drtv::test
