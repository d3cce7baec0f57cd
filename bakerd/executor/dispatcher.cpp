#include "bakerd/executor/dispatcher.h"

#include "bakerd/store/owner.h"
#include "bakerd/worker/build_id.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

namespace drtv::executor {
namespace {

// Taken up ahead of what is at work: before it is known how many fill an array, and at most.
constexpr std::size_t few_ready = 1000;
constexpr std::size_t max_ready = 400'000;

}  // namespace

store::Result<Dispatcher> Dispatcher::open(DispatchOptions options,
                                           Cluster& cluster,
                                           store::BlobStore& blobs,
                                           Executor::Callbacks callbacks) {
    auto folder = ArrayFolder::open(options.store_folder, options.owner);
    if (!folder)
        return tl::unexpected(folder.error());
    auto answers = worker::Answers::open(options.store_folder);
    if (!answers)
        return tl::unexpected(answers.error());
    // For who looks from a node (bakerd doctor).
    if (auto marked =
            store::write_mark(options.store_folder + "/build", worker::text_of(worker::this_build()));
        !marked)
        return tl::unexpected(marked.error());
    Dispatcher dispatcher(
        std::move(options), cluster, blobs, std::move(callbacks), std::move(*folder), std::move(*answers));
    if (auto loaded = dispatcher.load_arrays(); !loaded)
        return tl::unexpected(loaded.error());
    return dispatcher;
}

Dispatcher::Dispatcher(DispatchOptions options,
                       Cluster& cluster,
                       store::BlobStore& blobs,
                       Executor::Callbacks callbacks,
                       ArrayFolder folder,
                       worker::Answers answers)
    : options_(std::move(options)),
      cluster_(&cluster),
      blobs_(&blobs),
      callbacks_(std::move(callbacks)),
      folder_(std::move(folder)),
      answers_(std::move(answers)),
      opened_(now()),
      next_answers_(now()),
      next_queue_(now()),
      next_view_(now()) {}

Dispatcher::Time Dispatcher::step() {
    if (now() >= next_view_)
        view_cluster();
    pull();
    settle_left_behind();
    if (now() >= next_answers_ || !fresh_.empty())
        collect_answers();
    if (now() >= next_queue_) {
        give_up_unwanted();
        ask_queue();
        close_arrays();
        remove_spent_answers();
    }
    for (const Priority priority : {Priority::interactive, Priority::nightly})
        submit(priority);
    return sectors_.empty() && arrays_.empty() ? next_view_ : std::min(next_answers_, next_queue_);
}

// What fills the next array: with more, a job that comes later would wait behind it.
bool Dispatcher::is_enough(Priority priority, const Ready& ready, std::size_t sectors) const {
    if (sectors < few_ready)
        return false;
    if (!view_ || ready.unknown >= few_ready || sectors >= max_ready)
        return true;
    return ready.seconds >= static_cast<double>(tasks_of_array()) * batch_s(priority) * view_->task_threads;
}

void Dispatcher::count(const Digest& key, Ready& ready) const {
    const auto found = sectors_.find(key);
    const double cost = found == sectors_.end() ? 0 : cost_of(found->second);
    ready.seconds += cost;
    ready.unknown += static_cast<std::size_t>(cost == 0);
}

double Dispatcher::cost_of(const Sector& sector) const {
    return sector.seconds > 0 ? sector.seconds : costs_.seconds(sector.kind);
}

void Dispatcher::pull() {
    for (const Priority priority : {Priority::interactive, Priority::nightly}) {
        Ready& ready = this->ready(priority);
        // Their costs may have become known since.
        if (ready.unknown > 0) {
            ready.seconds = 0;
            ready.unknown = 0;
            for (const Digest& key : ready.keys)
                count(key, ready);
        }
        Ready ahead{{}, ready.seconds, ready.unknown, false};
        std::size_t sectors = ready.keys.size();
        while (!ahead.is_dry && !is_enough(priority, ahead, sectors)) {
            auto task = callbacks_.next(priority);
            ahead.is_dry = !task;
            const std::size_t waiting = fresh_.size();
            if (task)
                take_up(std::move(*task));
            // One that an earlier run's array has is at work.
            if (fresh_.size() > waiting) {
                ++sectors;
                count(fresh_.back(), ahead);
            }
        }
        ready.is_dry = ahead.is_dry;
    }
}

void Dispatcher::take_up(SectorTask task) {
    const Digest key = worker::answer_key(task.request);
    const auto [entry, is_new] = sectors_.try_emplace(key);
    Sector& sector = entry->second;
    sector.ids.push_back(task.id);
    if (!is_new) {
        // Two jobs want the same, and one of them was opened again.
        if (!sector.place)
            fresh_.push_back(key);
        return;
    }
    sector.request = std::move(task.request);
    sector.kind = Costs::kind_of(sector.request);
    sector.priority = task.priority;
    sector.seconds = task.seconds;
    const auto known = left_behind_.find(key);
    const auto array = known == left_behind_.end() ? arrays_.end() : arrays_.find(known->second.array);
    // Of a task that has ended no answer is awaited; one that it gave is found.
    if (array == arrays_.end() || !array->second.watch.expects(known->second.task, key)) {
        fresh_.push_back(key);
        return;
    }
    sector.place = known->second;
}

void Dispatcher::collect_answers() {
    next_answers_ = now() + options_.answers_every;
    const std::vector<Digest> fresh = std::exchange(fresh_, {});
    std::vector<Digest> asked = fresh;
    for (const auto& [key, sector] : sectors_) {
        if (sector.place)
            asked.push_back(key);
    }
    std::ranges::sort(asked);
    for (const auto& [key, answer] : answers_.find(asked)) {
        if (sectors_.contains(key))
            deliver(key, answer);
    }
    for (const Digest& key : fresh) {
        const auto left = sectors_.find(key);
        if (left == sectors_.end() || left->second.place)
            continue;
        Ready& ready = this->ready(left->second.priority);
        ready.keys.push_back(key);
        count(key, ready);
    }
}

void Dispatcher::deliver(const Digest& key, const worker::TaskAnswer& answer) {
    barren_.erase(answer.node);
    Sector& sector = sectors_.at(key);
    const auto* result = std::get_if<worker::SectorResult>(&answer.what);
    if (result == nullptr) {
        finish(key, tl::unexpected(std::get<worker::RequestFailure>(answer.what)), answer.node, answer.log);
        return;
    }
    const worker::ResultBlobs& blobs = result->blobs;
    if (!blobs_->has(blobs.file) || !blobs_->has(blobs.footprint) || !blobs_->has(blobs.inventory)) {
        answers_.remove(std::span(&key, 1));
        settle(key, sector);
        if (++sector.losses < max_losses)
            fresh_.push_back(key);
        else
            finish(key,
                   tl::unexpected(
                       worker::RequestFailure{"tasks baked it, but its files are not in the store", false}));
        return;
    }
    costs_.learn(sector.request, answer);
    finish(key, *result, answer.node, answer.log);
}

void Dispatcher::finish(const Digest& key,
                        const Reply<worker::SectorResult>& reply,
                        const std::string& node,
                        const std::string& log) {
    const auto found = sectors_.find(key);
    Sector sector = std::move(found->second);
    spent_.push_back({key, sector.ids, sector.place, now()});
    settle(key, sector);
    sectors_.erase(found);
    for (const std::uint64_t id : sector.ids)
        callbacks_.finished({id, sector.failures, reply, node, log});
}

void Dispatcher::settle(const Digest& key, Sector& sector) {
    if (!sector.place)
        return;
    if (const auto array = arrays_.find(sector.place->array); array != arrays_.end())
        array->second.watch.settle(sector.place->task, key);
    sector.place.reset();
}

void Dispatcher::give_up_unwanted() {
    for (auto entry = sectors_.begin(); entry != sectors_.end();) {
        auto& [key, sector] = *entry;
        std::erase_if(sector.ids, [this](std::uint64_t id) { return callbacks_.give_up(id); });
        if (!sector.ids.empty()) {
            ++entry;
            continue;
        }
        settle(key, sector);
        entry = sectors_.erase(entry);
    }
}

}  // namespace drtv::executor
