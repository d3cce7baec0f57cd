#include "bakerd/farm/job_queue.h"

#include <algorithm>
#include <limits>

namespace drtv::farm {

JobQueue::Rank JobQueue::rank_of(std::int64_t job, const QueuePlace& place) {
    return {-place.raised, job};
}

std::deque<std::uint64_t>& JobQueue::tasks_of(std::int64_t job, Job& known) {
    return known.place.is_held
               ? known.held
               : owners_of(known.place.priority)[known.place.owner].jobs[rank_of(job, known.place)];
}

std::deque<std::uint64_t> JobQueue::take_out(std::int64_t job, Job& known) {
    std::deque<std::uint64_t> tasks = std::move(tasks_of(job, known));
    if (!known.place.is_held)
        owners_of(known.place.priority)[known.place.owner].jobs.erase(rank_of(job, known.place));
    return tasks;
}

void JobQueue::put(std::int64_t job, QueuePlace place) {
    const auto [entry, is_new] = jobs_.try_emplace(job);
    Job& known = entry->second;
    std::deque<std::uint64_t> tasks;
    if (!is_new)
        tasks = take_out(job, known);
    known = {std::move(place), {}};
    tasks_of(job, known) = std::move(tasks);
}

void JobQueue::remove(std::int64_t job) {
    const auto found = jobs_.find(job);
    if (found == jobs_.end())
        return;
    static_cast<void>(take_out(job, found->second));
    jobs_.erase(found);
}

void JobQueue::push(std::int64_t job, std::uint64_t task) {
    tasks_of(job, jobs_.at(job)).push_back(task);
}

bool JobQueue::has_tasks(const Owner& owner) {
    return std::ranges::any_of(owner.jobs, [](const auto& job) { return !job.second.empty(); });
}

// Who had nothing to do has no claim to what the others had meanwhile (start-time fair queueing: Goyal, Vin
// and Cheng 1996).
void JobQueue::begin_turn(Owners& owners) {
    double least_s = std::numeric_limits<double>::infinity();
    for (const auto& [name, owner] : owners) {
        if (owner.is_waiting)
            least_s = std::min(least_s, owner.had_s);
    }
    for (auto& [name, owner] : owners) {
        const bool waits = has_tasks(owner);
        if (waits && !owner.is_waiting && least_s < std::numeric_limits<double>::infinity())
            owner.had_s = std::max(owner.had_s, least_s);
        owner.is_waiting = waits;
    }
}

JobQueue::Owners::iterator JobQueue::next_owner(Owners& owners, const std::string& last) const {
    auto first = owners.end();
    for (auto owner = owners.begin(); owner != owners.end(); ++owner) {
        if (owner->second.is_waiting && (first == owners.end() || owner->second.had_s < first->second.had_s))
            first = owner;
    }
    const auto current = owners.find(last);
    const bool goes_on = current != owners.end() && current->second.is_waiting &&
                         current->second.had_s < first->second.had_s + turn_s_;
    return goes_on ? current : first;
}

std::optional<std::uint64_t> JobQueue::next(executor::Priority priority, const Wants& wants) {
    Owners& owners = owners_of(priority);
    std::string& last = last_[static_cast<std::size_t>(priority)];
    for (;;) {
        begin_turn(owners);
        const auto first = next_owner(owners, last);
        if (first == owners.end())
            return std::nullopt;
        Owner& owner = first->second;
        const auto job =
            std::ranges::find_if(owner.jobs, [](const auto& entry) { return !entry.second.empty(); });
        const std::uint64_t task = job->second.front();
        job->second.pop_front();
        const Wanted wanted = wants(job->first.second, task);
        if (!wanted.is_wanted)
            continue;
        owner.had_s += wanted.seconds;
        last = first->first;
        return task;
    }
}

void JobQueue::charge(std::int64_t job, double seconds) {
    if (const auto found = jobs_.find(job); found != jobs_.end())
        owners_of(found->second.place.priority)[found->second.place.owner].had_s += seconds;
}

JobQueue::Line JobQueue::line_before(std::int64_t job) const {
    Line line;
    const auto found = jobs_.find(job);
    if (found == jobs_.end())
        return line;
    const QueuePlace& place = found->second.place;
    const auto add = [&line](const auto& entry) {
        if (!entry.second.empty())
            line.before.push_back(entry.first.second);
    };
    if (place.priority == executor::Priority::nightly) {
        for (const auto& [name, owner] : owners_of(executor::Priority::interactive))
            std::ranges::for_each(owner.jobs, add);
    }
    line.owners = 0;
    for (const auto& [name, owner] : owners_of(place.priority)) {
        line.owners += static_cast<std::size_t>(name == place.owner || has_tasks(owner));
        if (name != place.owner)
            continue;
        std::for_each(owner.jobs.begin(), owner.jobs.lower_bound(rank_of(job, place)), add);
    }
    return line;
}

}  // namespace drtv::farm
