// How the dispatcher makes arrays of what is ready.
#include "bakerd/executor/batches.h"
#include "bakerd/executor/dispatcher.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <random>

namespace drtv::executor {
namespace {

std::size_t max_open(Priority priority) {
    return priority == Priority::interactive ? 8 : 2;
}

std::string new_key() {
    std::random_device random;
    return fmt::format("drtv-{:08x}{:08x}", random(), random());
}

}  // namespace

// Better than to wait for somebody who mends the nodes and does not know that he should.
void Dispatcher::refuse_all(Priority priority) {
    const auto& [node, exclusion] = *excluded_.begin();
    const std::string why = fmt::format("no node may bake; of {}: {}", node, exclusion.why);
    for (const Digest& key : std::exchange(ready(priority), {}).keys) {
        if (const auto found = sectors_.find(key); found != sectors_.end() && !found->second.place)
            finish(key, tl::unexpected(worker::RequestFailure{why, false}));
    }
}

std::int64_t Dispatcher::memory_for(std::span<const std::vector<Digest>> batches) const {
    std::int64_t wanted = 0;
    for (const std::vector<Digest>& batch : batches) {
        for (const Digest& key : batch)
            wanted = std::max(wanted, costs_.memory_bytes(sectors_.at(key).request));
    }
    // A site that has not told Slurm of its nodes' memory has nodes of 1 MB.
    std::int64_t largest = 0;
    for (const ClusterNode& node : view_->nodes)
        largest = std::max(largest, node.memory_bytes);
    return largest < (std::int64_t{1} << 30) ? 0 : std::min(wanted, largest);
}

std::size_t Dispatcher::tasks_of_array() const {
    return std::min(executor::tasks_of_array(slots()), view_->max_tasks);
}

double Dispatcher::batch_s(Priority priority) const {
    if (priority == Priority::interactive)
        return options_.batch_s;
    return long_batch_s(options_.batch_s, costs_.load_seconds(), options_.max_batch_s);
}

Dispatcher::Cut Dispatcher::cut(Priority priority) {
    Ready& ready = this->ready(priority);
    const std::size_t taken = submissions(priority).max_tasks;
    const std::size_t most = taken > 0 ? std::min(taken, view_->max_tasks) : view_->max_tasks;
    std::vector<std::vector<Digest>> batches;
    std::vector<Digest> keys;
    std::vector<double> seconds;
    std::vector<Digest> unknown;
    std::deque<Digest> left;
    // What lies here may have been given up, or lie twice.
    std::set<Digest> seen;
    for (const Digest& key : ready.keys) {
        const auto found = sectors_.find(key);
        if (found == sectors_.end() || found->second.place || !seen.insert(key).second)
            continue;
        if (found->second.alone) {
            if (batches.size() < most)
                batches.push_back({key});
            else
                left.push_back(key);
            continue;
        }
        const double cost = cost_of(found->second);
        (cost > 0 ? keys : unknown).push_back(key);
        if (cost > 0)
            seconds.push_back(cost);
    }
    BatchRule rule;
    rule.batch_s = batch_s(priority);
    rule.least_s = least_batch_s(rule.batch_s, costs_.load_seconds());
    rule.threads = view_->task_threads;
    rule.slots = slots();
    rule.max_batches = most;
    if (!ready.is_dry)
        rule.max_batches = std::min(most, tasks_of_array());
    rule.max_batches -= std::min(rule.max_batches, batches.size());
    rule.is_last = ready.is_dry;
    const bool is_pilot = keys.empty();
    if (is_pilot) {
        // A few first, which tell what the others cost.
        keys.swap(unknown);
        seconds.assign(keys.size(), 1.0);
        rule.batch_s = pilot_batch_s(keys.size(), rule.slots, rule.threads);
        rule.is_last = false;
        const bool is_learning = std::ranges::any_of(arrays_, [&](const auto& array) {
            return array.second.is_pilot && array.second.priority == priority;
        });
        rule.max_batches = is_learning ? 0 : std::min(rule.max_batches, rule.slots);
    }
    std::size_t begin = 0;
    for (const std::size_t end : cut_batches(seconds, rule)) {
        batches.emplace_back(keys.begin() + static_cast<std::ptrdiff_t>(begin),
                             keys.begin() + static_cast<std::ptrdiff_t>(end));
        begin = end;
    }
    left.insert(left.end(), keys.begin() + static_cast<std::ptrdiff_t>(begin), keys.end());
    left.insert(left.end(), unknown.begin(), unknown.end());
    ready = {std::move(left), 0, 0, ready.is_dry};
    for (const Digest& key : ready.keys)
        count(key, ready);
    return {std::move(batches), is_pilot};
}

void Dispatcher::submit(Priority priority) {
    Submissions& submissions = this->submissions(priority);
    // What was refused is nobody's any more.
    if (!submissions.trouble.empty() && std::ranges::none_of(sectors_, [&](const auto& sector) {
            return sector.second.priority == priority;
        }))
        submissions = {};
    if (!view_ || now() < submissions.next || ready(priority).keys.empty())
        return;
    // A node that is down for a moment may be the one that can.
    const bool none_may =
        !view_->nodes.empty() &&
        std::ranges::all_of(view_->nodes, [this](const auto& node) { return excluded_.contains(node.name); });
    if (none_may) {
        refuse_all(priority);
        return;
    }
    const auto open =
        std::ranges::count_if(arrays_, [&](const auto& array) { return array.second.priority == priority; });
    if (static_cast<std::size_t>(open) >= max_open(priority))
        return;
    auto [batches, is_pilot] = cut(priority);
    if (batches.empty())
        return;
    ClusterArray array;
    array.key = new_key();
    array.tasks = batches.size();
    array.priority = priority;
    array.threads = view_->task_threads;
    array.memory_bytes = memory_for(batches);
    array.command = options_.task_command;
    const std::string logs = fmt::format("logs/{}", array.key);
    array.command.insert(array.command.end(), {"--array", folder_.path_of(array.key), "--logs", logs});
    array.log_folder = fmt::format("{}/{}", options_.store_folder, logs);
    for (const auto& [node, exclusion] : excluded_)
        array.excluded_nodes.insert(node);
    worker::ArrayFile file{worker::this_build(), {}};
    std::size_t sectors = 0;
    for (std::size_t task = 0; task < batches.size(); ++task) {
        std::vector<worker::BakeRequest>& batch = file.batches.emplace_back();
        for (const Digest& key : batches[task]) {
            Sector& sector = sectors_.at(key);
            sector.place = Place{array.key, task};
            batch.push_back(sector.request);
            ++sectors;
        }
    }
    std::error_code code;
    std::filesystem::create_directories(array.log_folder, code);
    const auto written = folder_.write(array.key, file);
    const auto taken =
        written ? cluster_->submit(array) : tl::unexpected(Refusal{written.error().message, false});
    ArrayWatch watch(batches, options_.patience, now());
    arrays_.emplace(
        array.key,
        Array{
            priority, std::move(batches), std::move(watch), array.memory_bytes, taken.has_value(), is_pilot});
    submissions.trouble = taken ? "" : taken.error().sentence;
    if (taken) {
        submissions.refusals = 0;
        submissions.max_tasks = 2 * submissions.max_tasks >= view_->max_tasks ? 0 : 2 * submissions.max_tasks;
        spdlog::info("array {}: tasks {}, sectors {}", array.key, array.tasks, sectors);
        return;
    }
    spdlog::warn("array {} was {}: {}",
                 array.key,
                 written ? "perhaps not taken" : "not submitted",
                 taken.error().sentence);
    submissions.next = now() + options_.pause * (1 << std::min(submissions.refusals++, 4));
    if (taken.error().is_too_large)
        submissions.max_tasks = std::max(array.tasks / 2, std::size_t{1});
}

}  // namespace drtv::executor
