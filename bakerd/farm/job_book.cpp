#include "bakerd/farm/job_book.h"

#include "bakerd/reuse/footprint.h"

#include <algorithm>

namespace drtv::farm {

void JobBook::add(JobRow row,
                  std::span<const WantedSector> wanted,
                  std::vector<std::string> warnings,
                  double expected_s) {
    const std::lock_guard lock(mutex_);
    Job& job = jobs_[row.id];
    job.row = std::move(row);
    job.warnings = std::move(warnings);
    job.expected_s = expected_s;
    if (!job.row.request_id.empty())
        by_request_[job.row.request_id] = job.row.id;
    want(job, wanted, Join::any);
}

void JobBook::reopen(const JobRow& row, std::span<const WantedSector> wanted) {
    const std::lock_guard lock(mutex_);
    Job& job = jobs_.at(row.id);
    job.row = row;
    job.started.reset();
    job.rays = 0;
    job.baked = 0;
    job.expected_s = 0;
    want(job, wanted, Join::waiting);
    changed(job);
}

void JobBook::want(Job& job, std::span<const WantedSector> wanted, Join join) {
    // A map from before there were inventories is like no other.
    const Digest& content = job.row.inventory == Digest{} ? job.row.manifest : job.row.inventory;
    BakeKey key{reuse::results_key(job.row.settings.bake), content, {}, 0};
    for (const WantedSector& sector : wanted) {
        key.sector = sector.sector;
        const std::uint64_t id = task_for(job, sector, key, join);
        Task& task = tasks_.at(id);
        task.jobs.insert(job.row.id);
        if (job.row.priority > task.priority) {
            task.priority = job.row.priority;
            put_in_queue(id, task);
        }
        job.tasks[sector.sector] = id;
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
    task.priority = job.row.priority;
    if (wanted.earlier) {
        task.request.earlier = wanted.earlier->result.blobs;
        task.earlier_seconds = wanted.earlier->result.seconds;
    }
    tasks_by_key_[key] = id;
    put_in_queue(id, task);
    return id;
}

// It may lie in the queue of a lower priority, too.
void JobBook::put_in_queue(std::uint64_t id, const Task& task) {
    if (!task.running)
        queues_[static_cast<std::size_t>(task.priority)].push_back(id);
}

std::optional<std::int64_t> JobBook::begin_request(const std::string& request_id) {
    if (request_id.empty())
        return std::nullopt;
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !open_requests_.contains(request_id); });
    if (const auto known = by_request_.find(request_id); known != by_request_.end())
        return known->second;
    open_requests_.insert(request_id);
    return std::nullopt;
}

void JobBook::end_request(const std::string& request_id) {
    {
        const std::lock_guard lock(mutex_);
        open_requests_.erase(request_id);
    }
    changed_.notify_all();
}

std::optional<executor::SectorTask> JobBook::next(executor::Priority priority) {
    const std::lock_guard lock(mutex_);
    std::deque<std::uint64_t>& queue = queues_[static_cast<std::size_t>(priority)];
    while (!queue.empty()) {
        const std::uint64_t id = queue.front();
        queue.pop_front();
        const auto found = tasks_.find(id);
        // Its jobs were cancelled, or it went to another queue.
        if (found == tasks_.end() || found->second.running || found->second.priority != priority)
            continue;
        Task& task = found->second;
        task.running = true;
        for (const std::int64_t job_id : task.jobs) {
            Job& job = jobs_.at(job_id);
            if (job.started)
                continue;
            job.started = Clock::now();
            changed(job);
        }
        return executor::SectorTask{id, task.request, task.priority, task.seconds};
    }
    return std::nullopt;
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
    if (task.jobs.empty())
        forget(id);
    else
        put_in_queue(id, task);
}

void JobBook::update(const JobRow& row, const worker::SectorResult* result) {
    const std::lock_guard lock(mutex_);
    Job& job = jobs_.at(row.id);
    // Writers tell the book after they have written, in any order: an end is final.
    if (job.row.state != JobState::running)
        return;
    if (row.request_id.empty())
        by_request_.erase(job.row.request_id);
    job.row = row;
    if (result != nullptr) {
        ++job.baked;
        job.rays += result->rays;
    }
    if (row.state != JobState::running)
        drop_tasks(job);
    changed(job);
}

void JobBook::warn(std::int64_t id, const std::string& sentence) {
    const std::lock_guard lock(mutex_);
    const auto found = jobs_.find(id);
    if (found == jobs_.end())
        return;
    std::vector<std::string>& warnings = found->second.warnings;
    if (warnings.size() < worker::max_warnings && std::ranges::find(warnings, sentence) == warnings.end()) {
        warnings.push_back(sentence);
        changed(found->second);
    }
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
}

void JobBook::forget(std::uint64_t id) {
    // A later task may have taken its place.
    const auto by_key = tasks_by_key_.find(tasks_.at(id).key);
    if (by_key != tasks_by_key_.end() && by_key->second == id)
        tasks_by_key_.erase(by_key);
    tasks_.erase(id);
}

void JobBook::changed(Job& job) {
    ++job.version;
    changed_.notify_all();
}

}  // namespace drtv::farm
