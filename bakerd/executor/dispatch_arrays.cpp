// The dispatcher's arrays and what the queue tells of them.
#include "bakerd/executor/dispatcher.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace drtv::executor {
namespace {

constexpr int max_releases = 3;
constexpr std::chrono::minutes spent_answers_stay(1);
// After the start, for what an earlier run has left at work.
constexpr std::chrono::minutes all_ask_within(1);

}  // namespace

store::Result<void> Dispatcher::load_arrays() {
    auto arrays = folder_.all();
    if (!arrays)
        return tl::unexpected(arrays.error());
    for (auto& [key, file] : *arrays) {
        if (file.batches.empty() || file.build != worker::this_build()) {
            spdlog::info("array {} is another build's: it is cancelled", key);
            cluster_->cancel(key);
            folder_.remove(key);
            continue;
        }
        std::vector<std::vector<Digest>> batches;
        std::vector<Digest> keys;
        for (const std::vector<worker::BakeRequest>& sectors : file.batches) {
            std::vector<Digest>& batch = batches.emplace_back();
            for (const worker::BakeRequest& request : sectors) {
                batch.push_back(worker::answer_key(request));
                keys.push_back(batch.back());
                left_behind_[batch.back()] = {key, batches.size() - 1};
            }
        }
        spdlog::info("array {} goes on: {} tasks", key, batches.size());
        ArrayWatch watch(batches, options_.patience, now());
        // Who asks for them again finds their answers.
        std::ranges::sort(keys);
        for (const auto& [answered, answer] : answers_.find(keys))
            watch.settle(left_behind_.at(answered).task, answered);
        // Whether the cluster heard of it is not known.
        arrays_.emplace(key, Array{Priority::nightly, std::move(batches), std::move(watch), 0, false});
    }
    return {};
}

// What nobody asks for, of an earlier run's arrays, was recorded then: its answer may be gone, and its tasks
// have nothing to do.
void Dispatcher::settle_left_behind() {
    if (left_behind_.empty() || now() < opened_ + all_ask_within ||
        !std::ranges::all_of(ready_, [](const Ready& ready) { return ready.is_dry; }))
        return;
    for (const auto& [key, place] : left_behind_) {
        const auto array = arrays_.find(place.array);
        if (array != arrays_.end() && !sectors_.contains(key))
            array->second.watch.settle(place.task, key);
    }
    left_behind_.clear();
}

void Dispatcher::ask_queue() {
    next_queue_ = now() + options_.queue_every;
    if (arrays_.empty())
        return;
    std::vector<std::string> keys;
    for (const auto& [key, array] : arrays_)
        keys.push_back(key);
    auto tasks = cluster_->list(keys);
    next_queue_ = now() + options_.queue_every;
    list_trouble_ = tasks ? "" : tasks.error();
    if (!tasks) {
        spdlog::warn("{}", tasks.error());
        return;
    }
    std::ranges::sort(*tasks, {}, &ClusterTask::key);
    for (auto& [key, array] : arrays_) {
        const auto rows = std::ranges::equal_range(*tasks, key, {}, &ClusterTask::key);
        array.watch.hear(rows, now());
        judge(key, array);
    }
}

// A requeued task waits until its old node would take it again: before that, the node drops it without a word
// (cred_expire in slurm.conf(5)). One whose node is gone waits for nothing.
bool Dispatcher::is_to_be_let_go(Array& array, const ClusterTask& task) {
    if (task.state == TaskState::held) {
        const bool again = array.releases[task.number]++ < max_releases;
        if (!again)
            list_trouble_ =
                fmt::format("a task is held: {} (scontrol release {}_{})", task.words, task.job, task.number);
        return again;
    }
    if (task.state != TaskState::delayed || task.node.empty())
        return false;
    if (now() >= viewed_ + options_.queue_every)
        view_cluster();
    return view_ && std::ranges::any_of(view_->nodes, [&](const ClusterNode& node) {
               return node.name == task.node && !node.is_up;
           });
}

void Dispatcher::judge(const std::string& key, Array& array) {
    std::vector<ClusterTask> waiting = array.watch.alive();
    std::erase_if(waiting, [&](const ClusterTask& task) { return !is_to_be_let_go(array, task); });
    cluster_->nudge(waiting);
    std::vector<EndedTask> ended = array.watch.take_ended(now());
    std::erase_if(ended, [&](const EndedTask& task) { return !is_missed(key, task); });
    for (const EndedTask& task : ended)
        try_again(key, array, task);
    const std::size_t lost = ended.size() + array.watch.take_requeued();
    lost_ += lost;
    // Nodes may have gone with them.
    if (lost > 0)
        next_view_ = shaken_ = now();
    if (!ended.empty())
        spdlog::info("array {}: {} tasks ended with sectors to bake: {}",
                     key,
                     ended.size(),
                     ended.front().last ? ended.front().last->words : "the cluster does not know them");
    if (const std::vector<ClusterTask> idle = array.watch.take_idle(); !idle.empty())
        cluster_->cancel(idle);
}

void Dispatcher::close_arrays() {
    std::erase_if(arrays_, [this](auto& entry) {
        auto& [key, array] = entry;
        if (!array.watch.is_over())
            return false;
        // Behind a daemon that was away more may be left than the last list shows.
        if (!array.watch.alive().empty())
            cluster_->cancel(key);
        folder_.remove(key);
        for (const std::vector<Digest>& batch : array.batches) {
            for (const Digest& sector : batch) {
                if (const auto left = left_behind_.find(sector);
                    left != left_behind_.end() && left->second.array == key)
                    left_behind_.erase(left);
            }
        }
        return true;
    });
}

bool Dispatcher::is_at_work(const Place& place) const {
    const auto array = arrays_.find(place.array);
    return array != arrays_.end() && !array->second.watch.is_settled(place.task);
}

// Until then a task that runs twice finds them, and a daemon that starts again.
void Dispatcher::remove_spent_answers() {
    const auto kept = std::ranges::partition(spent_, [this](const Spent& spent) {
                          return now() - spent.delivered < spent_answers_stay ||
                                 (spent.place && is_at_work(*spent.place)) ||
                                 !std::ranges::all_of(spent.ids, callbacks_.is_recorded);
                      }).begin();
    std::vector<Digest> gone;
    for (auto spent = kept; spent != spent_.end(); ++spent) {
        if (!sectors_.contains(spent->answer))
            gone.push_back(spent->answer);
    }
    answers_.remove(gone);
    spent_.erase(kept, spent_.end());
}

}  // namespace drtv::executor
