#include "bakerd/farm/job_book.h"

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
    job.baked_s = 0;
    job.expected_s = 0;
    want(job, wanted, Join::waiting);
    changed(job);
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

void JobBook::move(const JobRow& row) {
    const std::lock_guard lock(mutex_);
    Job& job = jobs_.at(row.id);
    if (job.row.state != JobState::running)
        return;
    job.row.raised = row.raised;
    job.row.held = row.held;
    queue_.put(row.id, place_of(job.row));
    changed(job);
}

void JobBook::update(const JobRow& row, const worker::SectorResult* result) {
    const std::lock_guard lock(mutex_);
    Job& job = jobs_.at(row.id);
    // Writers tell the book after they have written, in any order: an end is final.
    if (job.row.state != JobState::running)
        return;
    if (row.request_id.empty())
        by_request_.erase(job.row.request_id);
    // Its place may have changed since the row was read.
    const QueuePlace place = place_of(job.row);
    job.row = row;
    job.row.raised = place.raised;
    job.row.held = place.is_held;
    if (result != nullptr) {
        ++job.baked;
        job.baked_s += result->seconds;
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

void JobBook::changed(Job& job) {
    ++job.version;
    changed_.notify_all();
}

}  // namespace drtv::farm
