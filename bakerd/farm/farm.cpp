#include "bakerd/farm/farm.h"

#include "bakerd/farm/clock.h"
#include "bakerd/farm/database.h"
#include "bakerd/farm/job_store.h"
#include "bakerd/farm/job_table.h"
#include "bakerd/farm/maps.h"
#include "bakerd/farm/open_store.h"
#include "bakerd/farm/planner.h"
#include "bakerd/farm/recorder.h"
#include "bakerd/farm/result_cache.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace drtv::farm {

using store::ErrorCode;
using store::fail;
using store::Result;

Farm::Farm(Options options, std::unique_ptr<DataFolder> folder, std::unique_ptr<store::BlobStore> blobs)
    : options_(std::move(options)), folder_(std::move(folder)), blobs_(std::move(blobs)) {}

Result<std::unique_ptr<Farm>> Farm::open(Options options) {
    auto folder = DataFolder::lock(options.data_folder);
    if (!folder)
        return tl::unexpected(folder.error());
    auto blobs = open_store(options.store_folder, options.blob_folder(), **folder);
    if (!blobs)
        return tl::unexpected(blobs.error());
    (*blobs)->remove_leftovers();
    std::unique_ptr<Farm> farm(new Farm(std::move(options), std::move(*folder), std::move(*blobs)));
    if (auto loaded = farm->load(); !loaded)
        return tl::unexpected(loaded.error());
    if (auto started = farm->start(); !started)
        return tl::unexpected(started.error());
    return farm;
}

Result<void> Farm::load() {
    auto database = Database::open(folder_->database());
    if (!database)
        return tl::unexpected(database.error());
    database_ = std::move(*database);
    cache_ = std::make_unique<ResultCache>(*database_, *blobs_, options_.cache_bytes);
    if (auto opened = cache_->open(); !opened)
        return opened;
    return load_jobs(*database_, book_);
}

Result<void> Farm::start() {
    const auto owner = folder_->id();
    if (!owner)
        return tl::unexpected(owner.error());
    recorder_ = std::make_unique<Recorder>(*database_, *cache_, book_, [this] { executor_->wake(); });
    executor::Executor::Callbacks callbacks;
    callbacks.next = [this](executor::Priority priority) { return book_.next(priority); };
    callbacks.finished = [this](executor::SectorEnd end) {
        if (auto finished = book_.finish(std::move(end)))
            recorder_->record(std::move(*finished));
    };
    callbacks.give_up = [this](std::uint64_t id) { return book_.give_up(id); };
    callbacks.is_recorded = [this](std::uint64_t id) { return !book_.knows(id); };
    auto executor =
        open_executor(options_.executor, options_.store_folder, *owner, *blobs_, std::move(callbacks));
    if (!executor)
        return tl::unexpected(executor.error());
    executor_ = std::move(*executor);
    maps_ = std::make_unique<Maps>(*database_, *blobs_, *executor_);
    planner_ = std::make_unique<Planner>(*maps_, *cache_, *blobs_, *executor_);
    executor_->wake();
    return {};
}

Farm::~Farm() {
    stop(std::chrono::milliseconds(0));
}

void Farm::stop(std::chrono::milliseconds patience) {
    if (executor_)
        executor_->stop(patience);
    if (recorder_)
        recorder_->stop();
}

Result<MapView> Farm::create_map(store::Manifest manifest) {
    return maps_->create(std::move(manifest));
}

Result<MapView> Farm::get_map(const Digest& id) {
    return maps_->get(id);
}

Result<PlanView> Farm::plan_job(const JobRequest& request) {
    CachePin pin(*cache_);
    auto planned = planner_->plan(request, pin);
    if (!planned)
        return tl::unexpected(planned.error());
    const double seconds = seconds_to_bake(planned->plan, options_.executor.threads);
    return PlanView{std::move(planned->plan), seconds};
}

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
        return fail(ErrorCode::not_found, fmt::format("there is no job {}", id));
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

Result<std::vector<JobView>> Farm::list_jobs(std::int64_t before, std::size_t count) {
    std::vector<JobView> views;
    for (JobView& view : book_.list(before, count)) {
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
        return fail(ErrorCode::not_found, fmt::format("there is no job {}", id));
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

Result<std::vector<JobSectorView>> Farm::list_sectors(std::int64_t id,
                                                      std::optional<map::SectorCoordinate> after,
                                                      std::int64_t count) {
    return sector_views(*database_, book_, id, after, count);
}

Result<std::vector<JobSectorView>> Farm::get_sectors(std::int64_t id,
                                                     const std::vector<map::SectorCoordinate>& sectors) {
    return sector_views(*database_, book_, id, sectors);
}

Result<SectorLog> Farm::sector_log(std::int64_t id, map::SectorCoordinate sector) {
    const auto views = get_sectors(id, {sector});
    if (!views)
        return tl::unexpected(views.error());
    return read_sector_log(options_.store_folder, id, views->front());
}

Result<CacheView> Farm::cache() {
    const auto counts = cache_->counts();
    if (!counts)
        return tl::unexpected(counts.error());
    return CacheView{*counts, cache_->max_bytes()};
}

Result<CacheView> Farm::clear_cache() {
    if (auto cleared = cache_->clear(); !cleared)
        return tl::unexpected(cleared.error());
    return cache();
}

}  // namespace drtv::farm
