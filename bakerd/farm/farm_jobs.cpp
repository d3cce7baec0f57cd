// What the farm does with jobs.
#include "bakerd/farm/clock.h"
#include "bakerd/farm/farm.h"
#include "bakerd/farm/job_store.h"
#include "bakerd/farm/job_table.h"
#include "bakerd/farm/planner.h"
#include "bakerd/farm/result_cache.h"

#include <spdlog/spdlog.h>

#include <utility>

namespace drtv::farm {

using store::ErrorCode;
using store::fail;
using store::Result;

Result<JobView> Farm::create_job(const JobRequest& request, const std::function<bool()>& is_left) {
    if (request.request_id.size() > 64)
        return fail(ErrorCode::invalid_argument, "the request id is longer than 64 bytes");
    if (const auto same = book_.begin_request(request.request_id))
        return get_job(*same);
    // Whatever is thrown: others wait for the request's end.
    struct End {
        JobBook& book;
        const std::string& id;
        ~End() { book.end_request(id); }
    } end{book_, request.request_id};
    return create_planned(request, is_left);
}

Result<JobView> Farm::create_planned(const JobRequest& request, const std::function<bool()>& is_left) {
    CachePin pin(*cache_);
    auto planned = planner_->plan(request, pin);
    if (!planned)
        return tl::unexpected(planned.error());
    if (is_left())
        return fail(ErrorCode::aborted, "the client left before the job was made");
    JobRow job = new_job(request, planned->inventory);
    if (auto written = write_job(*database_, planned->plan, job); !written)
        return tl::unexpected(written.error());
    const std::int64_t id = job.id;
    book_.add(std::move(job),
              wanted_by(planned->plan),
              planned->plan.warnings,
              seconds_to_bake(planned->plan, options_.executor.threads));
    // Its client cannot know of it. Should it ask again, it gets another.
    if (is_left())
        return cancel_job(id, true);
    executor_->wake();
    return get_job(id);
}

Result<JobView> Farm::with_warnings(std::optional<JobView> view, std::int64_t id) {
    if (!view)
        return no_job(id);
    if (view->row.state == JobState::running) {
        view->cluster = executor_->cluster();
        return std::move(*view);
    }
    auto warnings = database_->read(
        [&](Connection& connection) { return warnings_of_job(connection, id, worker::max_warnings); });
    if (!warnings)
        return tl::unexpected(warnings.error());
    view->warnings.insert(view->warnings.end(), warnings->begin(), warnings->end());
    return std::move(*view);
}

Result<JobView> Farm::get_job(std::int64_t id) {
    return with_warnings(book_.view(id), id);
}

Result<std::vector<JobView>> Farm::list_jobs(std::int64_t before,
                                             std::size_t count,
                                             const std::optional<std::string>& owner) {
    std::vector<JobView> views;
    for (JobView& view : book_.list(before, count, owner)) {
        const std::int64_t id = view.row.id;
        auto complete = with_warnings(std::move(view), id);
        if (!complete)
            return tl::unexpected(complete.error());
        views.push_back(std::move(*complete));
    }
    return views;
}

Result<JobView> Farm::cancel_job(std::int64_t id, bool forget_request) {
    if (!book_.view(id))
        return no_job(id);
    std::optional<JobRow> cancelled;
    const auto written = database_->write([&](Connection& connection) {
        auto job = find_job(connection, id);
        if (!job || job->row.state != JobState::running)
            return;
        job->row.state = job->sound ? JobState::cancelled : JobState::failed;
        job->row.error = job->sound ? "" : damaged_row;
        job->row.ended_ms = unix_milliseconds();
        if (forget_request)
            job->row.request_id.clear();
        update_job(connection, job->row);
        cancelled = std::move(job->row);
    });
    if (!written)
        return tl::unexpected(written.error());
    if (cancelled) {
        book_.update(*cancelled);
        cache_->job_ended();
        executor_->wake();
        spdlog::info("job {} was cancelled", id);
    }
    return get_job(id);
}

Result<JobView> Farm::move(std::int64_t id, const std::function<void(JobRow& job)>& change) {
    if (auto moved = move_job(*database_, id, book_, change); !moved)
        return tl::unexpected(moved.error());
    executor_->wake();
    return get_job(id);
}

Result<JobView> Farm::raise_job(std::int64_t id) {
    // Who is raised last goes first.
    return move(id, [](JobRow& job) { job.raised = unix_milliseconds(); });
}

Result<JobView> Farm::hold_job(std::int64_t id, bool held) {
    return move(id, [held](JobRow& job) { job.held = held; });
}

Result<JobView> Farm::retry_job(std::int64_t id) {
    if (auto retried = farm::retry_job(*database_, id, book_); !retried)
        return tl::unexpected(retried.error());
    executor_->wake();
    return get_job(id);
}

Result<JobView> Farm::wait_for_change(std::int64_t id,
                                      std::uint64_t seen,
                                      std::chrono::milliseconds patience) {
    return with_warnings(book_.wait_for_change(id, seen, patience), id);
}

}  // namespace drtv::farm
