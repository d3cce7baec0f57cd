// What the book tells of its jobs.
#include "bakerd/farm/job_book.h"

#include <iterator>

namespace drtv::farm {

JobView JobBook::view_of(const Job& job) const {
    JobView view;
    view.row = job.row;
    view.rays = job.rays;
    view.version = job.version;
    view.warnings = job.warnings;
    if (job.row.state != JobState::running)
        return view;
    view.waiting = !job.started;
    view.seconds_left = job.expected_s;
    if (job.started && job.baked > 0) {
        const double seconds = std::chrono::duration<double>(Clock::now() - *job.started).count();
        view.rays_per_second = static_cast<double>(job.rays) / seconds;
        const std::int64_t left = job.row.sectors_total - job.row.sectors_done - job.row.sectors_failed;
        view.seconds_left = seconds / static_cast<double>(job.baked) * static_cast<double>(left);
    }
    if (view.waiting && !job.row.held)
        add_wait(view);
    return view;
}

// What is at work now has its share already; for what waits the estimate is of the whole machine.
void JobBook::add_wait(JobView& view) const {
    const JobQueue::Line line = queue_.line_before(view.row.id);
    view.jobs_ahead = static_cast<std::int64_t>(line.before.size());
    for (const std::int64_t id : line.before) {
        const Job& ahead = jobs_.at(id);
        const bool is_begun = ahead.started && ahead.baked > 0;
        const double seconds =
            is_begun ? view_of(ahead).seconds_left : ahead.expected_s * static_cast<double>(line.owners);
        if (seconds == 0) {
            view.seconds_to_start = 0;
            return;
        }
        view.seconds_to_start += seconds;
    }
}

std::optional<JobView> JobBook::view(std::int64_t id) const {
    const std::lock_guard lock(mutex_);
    const auto found = jobs_.find(id);
    return found == jobs_.end() ? std::nullopt : std::optional(view_of(found->second));
}

std::vector<JobView> JobBook::list(std::int64_t before,
                                   std::size_t count,
                                   const std::optional<std::string>& owner) const {
    const std::lock_guard lock(mutex_);
    std::vector<JobView> views;
    auto entry = std::make_reverse_iterator(jobs_.lower_bound(before));
    for (; entry != jobs_.rend() && views.size() < count; ++entry) {
        if (!owner || entry->second.row.owner == *owner)
            views.push_back(view_of(entry->second));
    }
    return views;
}

std::optional<JobView> JobBook::wait_for_change(std::int64_t id,
                                                std::uint64_t seen,
                                                std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    const auto found = jobs_.find(id);
    if (found == jobs_.end())
        return std::nullopt;
    // Jobs are never removed, and a map keeps its elements in place.
    changed_.wait_for(lock, patience, [&] { return found->second.version > seen; });
    return view_of(found->second);
}

bool JobBook::knows(std::uint64_t id) const {
    const std::lock_guard lock(mutex_);
    return tasks_.contains(id);
}

bool JobBook::is_running(std::int64_t id, map::SectorCoordinate sector) const {
    const std::lock_guard lock(mutex_);
    const auto job = jobs_.find(id);
    if (job == jobs_.end())
        return false;
    const auto task = job->second.tasks.find(sector);
    return task != job->second.tasks.end() && tasks_.at(task->second).running;
}

}  // namespace drtv::farm
