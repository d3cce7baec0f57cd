// What the dispatcher sees of the cluster, and shows.
#include "bakerd/executor/dispatcher.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace drtv::executor {
namespace {

// After tasks were lost, nodes are looked at more often for so long.
constexpr std::chrono::minutes nodes_come_back_in(2);

}  // namespace

void Dispatcher::view_cluster() {
    auto view = cluster_->view();
    viewed_ = now();
    view_trouble_ = view ? "" : view.error();
    const bool is_shaken = !view || now() < shaken_ + nodes_come_back_in;
    next_view_ = now() + (is_shaken ? 2 * options_.queue_every : options_.cluster_every);
    if (!view) {
        spdlog::warn("{}", view.error());
        return;
    }
    cluster_->mend(*view);
    view_ = std::move(*view);
    std::erase_if(excluded_, [this](const auto& node) { return node.second.until <= now(); });
}

ClusterState Dispatcher::state() const {
    ClusterState state;
    for (const auto& [key, array] : arrays_) {
        for (const ClusterTask& task : array.watch.alive())
            ++(task.state == TaskState::running ? state.tasks_running : state.tasks_waiting);
    }
    state.tasks_lost = lost_;
    for (const std::string* trouble :
         {&submissions_[1].trouble, &submissions_[0].trouble, &list_trouble_, &view_trouble_}) {
        if (state.trouble.empty())
            state.trouble = *trouble;
    }
    if (!view_)
        return state;
    state.nodes = view_->nodes.size();
    for (const ClusterNode& node : view_->nodes) {
        state.nodes_up += static_cast<std::size_t>(may_bake(node));
        if (may_bake(node) || !state.trouble.empty())
            continue;
        const auto excluded = excluded_.find(node.name);
        state.trouble = fmt::format("{} cannot bake: {}",
                                    node.name,
                                    excluded == excluded_.end() ? node.reason : excluded->second.why);
    }
    return state;
}

bool Dispatcher::may_bake(const ClusterNode& node) const {
    return node.is_up && !excluded_.contains(node.name);
}

std::size_t Dispatcher::slots() const {
    std::size_t slots = 0;
    for (const ClusterNode& node : view_->nodes) {
        if (may_bake(node))
            slots += static_cast<std::size_t>(node.threads / view_->task_threads);
    }
    return std::max(slots, std::size_t{1});
}

}  // namespace drtv::executor
