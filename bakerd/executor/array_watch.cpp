#include "bakerd/executor/array_watch.h"

#include <algorithm>
#include <map>
#include <utility>

namespace drtv::executor {
namespace {

bool is_alive(const ClusterTask& task) {
    return task.state <= TaskState::running;
}

}  // namespace

ArrayWatch::ArrayWatch(const std::vector<std::vector<Digest>>& batches, Patience patience, Time now)
    : patience_(patience) {
    for (const std::vector<Digest>& batch : batches) {
        Task& task = tasks_.emplace_back();
        task.unanswered = batch;
        task.sectors = batch.size();
        task.heard = now;
    }
}

std::chrono::milliseconds ArrayWatch::patience_for(const ClusterTask& ended) const {
    return ended.state == TaskState::done && ended.exit_status == 0 ? patience_.sure_answer
                                                                    : patience_.answer;
}

bool ArrayWatch::expects(std::size_t task, const Digest& answer) const {
    return task < tasks_.size() &&
           std::ranges::find(tasks_[task].unanswered, answer) != tasks_[task].unanswered.end();
}

void ArrayWatch::settle(std::size_t task, const Digest& answer) {
    std::erase(tasks_.at(task).unanswered, answer);
}

void ArrayWatch::hear(std::span<const ClusterTask> tasks, Time now) {
    // A number that the cluster gave twice shows two arrays of one name: a task lives while one of them does.
    std::map<std::size_t, const ClusterTask*> by_number;
    for (const ClusterTask& task : tasks) {
        const ClusterTask*& known = by_number[task.number];
        if (known == nullptr || is_alive(task))
            known = &task;
    }
    is_known_ = is_known_ || !tasks.empty();
    for (std::size_t number = 0; number < tasks_.size(); ++number) {
        Task& task = tasks_[number];
        const auto found = by_number.find(number);
        task.is_alive = found != by_number.end() && is_alive(*found->second);
        if (found == by_number.end())
            continue;
        task.idle_lists = task.is_alive && task.unanswered.empty() ? task.idle_lists + 1 : 0;
        task.last = *found->second;
        const bool is_running = task.last->state == TaskState::running;
        // It was put into the queue again.
        if (task.is_alive && !is_running && task.is_running)
            ++requeued_;
        task.is_running = is_running;
        if (is_running)
            task.node = task.last->node;
        else if (task.is_alive)
            task.last->node = task.node;
        if (task.is_alive) {
            task.heard = now;
            task.ended.reset();
        } else if (!task.ended) {
            task.ended = now;
        }
    }
}

std::vector<EndedTask> ArrayWatch::take_ended(Time now) {
    std::vector<EndedTask> ended;
    for (Task& task : tasks_) {
        if (task.is_taken || task.is_alive || task.unanswered.empty())
            continue;
        if (task.ended ? now - *task.ended < patience_for(*task.last) : now - task.heard < patience_.silence)
            continue;
        task.is_taken = true;
        ended.push_back(
            {std::exchange(task.unanswered, {}), task.sectors, task.ended ? task.last : std::nullopt});
    }
    return ended;
}

bool ArrayWatch::is_over() const {
    return std::ranges::all_of(tasks_, [](const Task& task) { return task.unanswered.empty(); });
}

std::vector<ClusterTask> ArrayWatch::alive() const {
    std::vector<ClusterTask> alive;
    for (const Task& task : tasks_) {
        if (task.is_alive && task.last)
            alive.push_back(*task.last);
    }
    return alive;
}

std::vector<ClusterTask> ArrayWatch::take_idle() {
    std::vector<ClusterTask> idle;
    for (Task& task : tasks_) {
        if (!task.is_alive || task.idle_lists < 2 || task.is_taken)
            continue;
        task.is_taken = true;
        idle.push_back(*task.last);
    }
    return idle;
}

}  // namespace drtv::executor
