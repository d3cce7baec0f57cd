// The book's sectors: who wants them, whose turn it is, and what has come of them.
#include "bakerd/farm/job_book.h"
#include "bakerd/reuse/footprint.h"

namespace drtv::farm {

void JobBook::want(Job& job, std::span<const WantedSector> wanted, Join join) {
    // A map from before there were inventories is like no other.
    const Digest& content = job.row.inventory == Digest{} ? job.row.manifest : job.row.inventory;
    if (wanted.empty())
        return;
    queue_.put(job.row.id, place_of(job.row));
    BakeKey key{reuse::results_key(job.row.settings.bake), content, {}, 0};
    for (const WantedSector& sector : wanted) {
        key.sector = sector.sector;
        const std::uint64_t id = task_for(job, sector, key, join);
        tasks_.at(id).jobs.insert(job.row.id);
        job.tasks[sector.sector] = id;
        queue_.push(job.row.id, id);
    }
}

// One that asks for the exact result serves as well: better than to bake the sector twice.
std::uint64_t JobBook::task_for(const Job& job, const WantedSector& wanted, BakeKey key, Join join) {
    for (const float tolerance : {0.0f, job.row.settings.tolerance}) {
        key.tolerance = tolerance;
        const auto known = tasks_by_key_.find(key);
        if (known != tasks_by_key_.end() && (join == Join::any || !tasks_.at(known->second).running))
            return known->second;
    }
    const std::uint64_t id = next_task_++;
    Task& task = tasks_[id];
    task.key = key;
    task.request = {job.row.manifest, wanted.sector, job.row.settings, {}};
    task.seconds = wanted.seconds;
    if (wanted.earlier) {
        task.request.earlier = wanted.earlier->result.blobs;
        task.earlier_seconds = wanted.earlier->result.seconds;
    }
    tasks_by_key_[key] = id;
    return id;
}

std::optional<executor::SectorTask> JobBook::next(executor::Priority priority) {
    const std::lock_guard lock(mutex_);
    const auto turn =
        queue_.next(priority, [this](std::int64_t job, std::uint64_t id) { return begin(job, id); });
    if (!turn)
        return std::nullopt;
    const Task& task = tasks_.at(*turn);
    return executor::SectorTask{*turn, task.request, priority, task.seconds};
}

// Whether it is still to be baked, and what it is thought to take.
JobQueue::Wanted JobBook::begin(std::int64_t turn, std::uint64_t id) {
    const auto found = tasks_.find(id);
    // Its jobs were cancelled, or it was another job's turn before.
    if (found == tasks_.end() || found->second.running)
        return {};
    Task& task = found->second;
    task.running = true;
    task.charged_job = turn;
    const Job& job = jobs_.at(turn);
    task.charged_s = task.seconds;
    if (task.charged_s == 0)
        task.charged_s = job.baked > 0 ? job.baked_s / static_cast<double>(job.baked) : 1;
    for (const std::int64_t job_id : task.jobs) {
        Job& begun = jobs_.at(job_id);
        if (begun.started)
            continue;
        begun.started = Clock::now();
        changed(begun);
    }
    return {true, task.charged_s};
}

bool JobBook::give_up(std::uint64_t id) {
    const std::lock_guard lock(mutex_);
    const auto found = tasks_.find(id);
    if (found == tasks_.end())
        return true;
    if (!found->second.jobs.empty())
        return false;
    forget(id);
    return true;
}

std::optional<FinishedSector> JobBook::finish(executor::SectorEnd end) {
    const std::lock_guard lock(mutex_);
    const auto found = tasks_.find(end.id);
    if (found == tasks_.end())
        return std::nullopt;
    Task& task = found->second;
    queue_.charge(task.charged_job, (end.reply ? end.reply->seconds : 0) - task.charged_s);
    // What it takes from nothing is known of the earlier result.
    if (end.reply && task.earlier_seconds > 0)
        end.reply->seconds = task.earlier_seconds;
    return FinishedSector{task.key, {task.jobs.begin(), task.jobs.end()}, std::move(end)};
}

std::vector<std::int64_t> JobBook::leave(std::uint64_t id, std::span<const std::int64_t> recorded) {
    const std::lock_guard lock(mutex_);
    const auto found = tasks_.find(id);
    if (found == tasks_.end())
        return {};
    Task& task = found->second;
    for (const std::int64_t job_id : recorded) {
        task.jobs.erase(job_id);
        // One that was opened again waits for another task.
        auto& tasks = jobs_.at(job_id).tasks;
        if (const auto known = tasks.find(task.key.sector); known != tasks.end() && known->second == id)
            tasks.erase(known);
    }
    const std::vector<std::int64_t> left(task.jobs.begin(), task.jobs.end());
    if (left.empty())
        forget(id);
    return left;
}

void JobBook::put_back(std::uint64_t id) {
    const std::lock_guard lock(mutex_);
    const auto found = tasks_.find(id);
    if (found == tasks_.end())
        return;
    Task& task = found->second;
    task.running = false;
    for (const std::int64_t job : task.jobs)
        queue_.push(job, id);
    if (task.jobs.empty())
        forget(id);
}

void JobBook::drop_tasks(Job& job) {
    for (const auto& [sector, id] : job.tasks) {
        Task& task = tasks_.at(id);
        task.jobs.erase(job.row.id);
        // One that is at work is forgotten when it ends.
        if (task.jobs.empty() && !task.running)
            forget(id);
    }
    job.tasks.clear();
    queue_.remove(job.row.id);
}

void JobBook::forget(std::uint64_t id) {
    // A later task may have taken its place.
    const auto by_key = tasks_by_key_.find(tasks_.at(id).key);
    if (by_key != tasks_by_key_.end() && by_key->second == id)
        tasks_by_key_.erase(by_key);
    tasks_.erase(id);
}

}  // namespace drtv::farm
