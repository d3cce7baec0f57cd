#include "bakerd/farm/farm.h"

#include "bakerd/reuse/footprint.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace drtv::farm {
namespace {

std::int64_t unix_seconds() {
    return std::chrono::duration_cast<std::chrono::seconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

}  // namespace

Farm::Farm(Options options,
           std::unique_ptr<DataFolder> folder,
           std::unique_ptr<BlobStore> blobs,
           std::unique_ptr<Database> database)
    : options_(std::move(options)),
      folder_(std::move(folder)),
      blobs_(std::move(blobs)),
      database_(std::move(database)) {}

Result<std::unique_ptr<Farm>> Farm::open(Options options) {
    auto folder = DataFolder::lock(options.data_folder);
    if (!folder)
        return tl::unexpected(folder.error());
    auto blobs = BlobStore::open((*folder)->blobs());
    if (!blobs)
        return tl::unexpected(blobs.error());
    (*blobs)->remove_leftovers();
    auto database = Database::open((*folder)->database());
    if (!database)
        return tl::unexpected(database.error());
    std::unique_ptr<Farm> farm(
        new Farm(std::move(options), std::move(*folder), std::move(*blobs), std::move(*database)));
    if (auto loaded = farm->load(); !loaded)
        return tl::unexpected(loaded.error());
    LocalExecutor::Callbacks callbacks;
    callbacks.next = [&farm = *farm] { return farm.next_task(); };
    callbacks.finished = [&farm = *farm](std::uint64_t id, int failed_attempts, const Outcome& outcome) {
        farm.task_finished(static_cast<std::int64_t>(id), failed_attempts, outcome);
    };
    farm->executor_ = std::make_unique<LocalExecutor>(
        LocalExecutor::Options{.worker_command = farm->options_.worker_command,
                               .threads = farm->options_.threads},
        std::move(callbacks));
    farm->executor_->wake();
    return farm;
}

Farm::~Farm() {
    executor_.reset();
}

void Farm::stop(std::chrono::milliseconds patience) {
    if (executor_)
        executor_->stop(patience);
}

Result<void> Farm::load() {
    const std::lock_guard lock(mutex_);
    const auto counts = database_->cache_counts();
    if (!counts)
        return tl::unexpected(counts.error());
    cache_bytes_ = counts->bytes;
    auto rows = database_->jobs();
    if (!rows)
        return tl::unexpected(rows.error());
    for (JobRow& row : *rows) {
        const std::int64_t id = row.id;
        Job& job = jobs_[id];
        job.row = std::move(row);
        if (job.row.state != JobState::running)
            continue;
        auto tasks = database_->job_tasks(id);
        if (!tasks)
            return tl::unexpected(tasks.error());
        std::vector<map::SectorCoordinate> sectors;
        for (const TaskRow& task : *tasks)
            sectors.push_back(task.sector);
        const auto order = sectors_of(std::nullopt, sectors);
        if (!order)
            return tl::unexpected(order.error());
        adopt(job, std::move(*tasks), *order);
        spdlog::info("job {} goes on: {} of {} sectors are done", id, job.counts.done, job.counts.total);
        end_job_if_complete(job);
    }
    return {};
}

// Brings a running job's tasks into memory and the unfinished ones into the queue, in the given order.
void Farm::adopt(Job& job, std::vector<TaskRow> tasks, const std::vector<map::SectorCoordinate>& order) {
    std::map<map::SectorCoordinate, std::int64_t> id_of;
    for (TaskRow& row : tasks) {
        const std::int64_t id = row.id;
        id_of[row.sector] = id;
        job.tasks.push_back(id);
        ++job.counts.total;
        if (row.state == TaskState::done) {
            ++job.counts.done;
            job.counts.probes += row.result.probes;
        }
        if (row.state == TaskState::failed)
            ++job.counts.failed;
        job.row.largest_bound = std::max(job.row.largest_bound, row.bound);
        const auto [entry, added] = tasks_.try_emplace(id);
        Task& task = entry->second;
        if (!added && task.row.state != TaskState::pending && row.state == TaskState::pending)
            reopen(task);
        if (added || !task.running)
            task.row = std::move(row);
        task.jobs.push_back(job.row.id);
    }
    for (const map::SectorCoordinate& sector : order) {
        if (tasks_[id_of[sector]].row.state == TaskState::pending)
            waiting_.push_back(id_of[sector]);
    }
}

// A task that is asked for anew is unfinished again for the running jobs that had counted it.
void Farm::reopen(const Task& task) {
    for (std::int64_t id : task.jobs) {
        Job& job = jobs_.at(id);
        if (task.row.state == TaskState::done) {
            --job.counts.done;
            job.counts.probes -= task.row.result.probes;
        } else {
            --job.counts.failed;
        }
        changed(job);
    }
}

Result<MapView> Farm::create_map(Manifest given) {
    auto manifest = normalised(std::move(given));
    if (!manifest)
        return tl::unexpected(manifest.error());
    for (const ManifestFile& file : manifest->files) {
        if (!blobs_->has(file.digest))
            return fail(ErrorCode::failed_precondition,
                        fmt::format("the file '{}' has not been uploaded", file.path));
    }
    const std::string bytes = encode_manifest(*manifest);
    const auto id = blobs_->put({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    if (!id)
        return tl::unexpected(id.error());
    {
        const std::lock_guard lock(mutex_);
        auto known = database_->map(*id);
        if (!known)
            return tl::unexpected(known.error());
        // One from before there were inventories is looked at again.
        if (*known && (*known)->inventory != Digest{})
            return MapView{*id, std::move(*manifest), std::move(**known)};
    }
    const Outcome outcome = executor_->ask(InspectRequest{0, *id}).get();
    if (const auto* failure = std::get_if<FailureAnswer>(&outcome)) {
        return fail(failure->may_retry ? ErrorCode::unavailable : ErrorCode::invalid_argument,
                    failure->sentence);
    }
    const auto* summary = std::get_if<InspectAnswer>(&outcome);
    if (summary == nullptr)
        return fail(ErrorCode::internal, "the worker gave an answer to another question");
    const std::lock_guard lock(mutex_);
    if (auto put = database_->put_map(*id, *summary); !put)
        return tl::unexpected(put.error());
    return MapView{*id, std::move(*manifest), *summary};
}

Result<MapView> Farm::get_map(const Digest& id) {
    std::optional<InspectAnswer> summary;
    {
        const std::lock_guard lock(mutex_);
        auto found = database_->map(id);
        if (!found)
            return tl::unexpected(found.error());
        summary = std::move(*found);
    }
    if (!summary)
        return fail(ErrorCode::not_found, fmt::format("there is no map {}", to_hex(id)));
    const auto bytes = blobs_->get(id);
    if (!bytes)
        return tl::unexpected(bytes.error());
    auto manifest = decode_manifest({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    if (!manifest)
        return tl::unexpected(manifest.error());
    return MapView{id, std::move(*manifest), std::move(*summary)};
}

Result<Farm::Planned> Farm::make_plan(const JobRequest& request) {
    const auto settings = settings_of(request);
    if (!settings)
        return tl::unexpected(settings.error());
    Planned planned{*settings, {}, {}};
    {
        const std::lock_guard lock(mutex_);
        auto map = database_->map(request.manifest);
        if (!map)
            return tl::unexpected(map.error());
        if (!*map)
            return fail(ErrorCode::not_found, fmt::format("there is no map {}", to_hex(request.manifest)));
        planned.map = std::move(**map);
        const auto sectors = sectors_of(request.region, planned.map.sectors);
        if (!sectors)
            return tl::unexpected(sectors.error());
        auto plan = look_up(*database_, *blobs_, planned.map, *settings, *sectors);
        if (!plan)
            return tl::unexpected(plan.error());
        planned.plan = std::move(*plan);
    }
    if (const auto question = question_of(planned.plan, request.manifest, *settings)) {
        const Outcome outcome = executor_->ask(*question).get();
        if (const auto* answer = std::get_if<AssessAnswer>(&outcome)) {
            apply(*answer, planned.plan);
        } else {
            // Then everything is baked that is not known for certain.
            const auto* failure = std::get_if<FailureAnswer>(&outcome);
            planned.plan.warnings.push_back(fmt::format(
                "older results could not be looked at: {}",
                failure != nullptr ? failure->sentence : "the worker gave an answer to another question"));
        }
    }
    drop_damaged(*blobs_, planned.plan);
    for (const std::string& warning : planned.plan.warnings)
        spdlog::warn("{}", warning);
    return planned;
}

Result<PlanView> Farm::plan_job(const JobRequest& request) {
    auto planned = make_plan(request);
    if (!planned)
        return tl::unexpected(planned.error());
    PlanView view{std::move(planned->plan), 0};
    for (const PlannedSector& sector : view.plan.sectors) {
        if (sector.verdict == reuse::Verdict::rebake)
            view.seconds += sector.seconds;
    }
    view.seconds /= static_cast<double>(
        std::clamp<std::int64_t>(view.plan.count(reuse::Verdict::rebake), 1, options_.threads));
    return view;
}

Result<JobView> Farm::create_job(const JobRequest& request) {
    if (request.request_id.size() > 64)
        return fail(ErrorCode::invalid_argument, "the request id is longer than 64 bytes");
    const auto same_request = [&] {
        return std::ranges::find_if(jobs_, [&](const auto& entry) {
            return !request.request_id.empty() && entry.second.row.request_id == request.request_id;
        });
    };
    {
        const std::lock_guard lock(mutex_);
        if (const auto same = same_request(); same != jobs_.end())
            return view_of(same->second);
    }
    auto planned = make_plan(request);
    if (!planned)
        return tl::unexpected(planned.error());
    std::unique_lock lock(mutex_);
    if (const auto same = same_request(); same != jobs_.end())
        return view_of(same->second);

    Job job;
    job.row.request_id = request.request_id;
    job.row.manifest = request.manifest;
    job.row.preset = request.preset;
    job.row.settings = planned->settings;
    job.row.overrides = encode_overrides(request.overrides);
    job.row.region = encode_region(request.region);
    job.row.created_seconds = unix_seconds();
    job.warnings = planned->plan.warnings;
    auto tasks = carry_out(job.row, planned->map.content, planned->plan);
    if (!tasks)
        return tl::unexpected(tasks.error());
    const std::int64_t id = job.row.id;
    Job& kept = jobs_[id] = std::move(job);
    std::vector<map::SectorCoordinate> order;
    for (const PlannedSector& sector : planned->plan.sectors)
        order.push_back(sector.sector);
    std::vector<std::int64_t> ids;
    for (const TaskRow& task : *tasks)
        ids.push_back(task.id);
    adopt(kept, std::move(*tasks), order);
    for (std::size_t n = 0; n < ids.size(); ++n) {
        Task& task = tasks_.at(ids[n]);
        if (!task.running && !task.earlier)
            task.earlier = planned->plan.sectors[n].earlier;
    }
    spdlog::info("job {}: {} sectors, {} of them in the cache, {} nearly so",
                 id,
                 kept.counts.total,
                 kept.row.sectors_cached,
                 kept.row.sectors_near);
    end_job_if_complete(kept);
    auto view = view_of(kept);
    lock.unlock();
    executor_->wake();
    return view;
}

// Writes the job with its tasks, new or known, in one transaction.
Result<std::vector<TaskRow>> Farm::carry_out(JobRow& row, const Digest& content, const Plan& plan) {
    std::vector<TaskRow> tasks;
    const auto done = database_->transaction([&]() -> Result<void> {
        for (const PlannedSector& planned : plan.sectors) {
            auto task = find_or_add_task(row, content, planned);
            if (!task)
                return tl::unexpected(task.error());
            if (task->state == TaskState::done) {
                ++(task->bound > 0 ? row.sectors_near : row.sectors_cached);
                row.largest_bound = std::max(row.largest_bound, task->bound);
                if (auto marked = database_->mark_used(task->sector, task->result.result); !marked)
                    return marked;
            }
            tasks.push_back(std::move(*task));
        }
        if (auto counted = database_->count(row.sectors_cached, row.sectors_near, 0); !counted)
            return counted;
        if (auto inserted = database_->insert_job(row); !inserted)
            return inserted;
        for (const TaskRow& task : tasks) {
            if (auto added = database_->add_job_task(row.id, task.id); !added)
                return added;
        }
        return {};
    });
    if (!done)
        return tl::unexpected(done.error());
    return tasks;
}

Result<TaskRow> Farm::find_or_add_task(const JobRow& job,
                                       const Digest& content,
                                       const PlannedSector& planned) {
    bake::Settings exact = job.settings;
    exact.tolerance = 0;
    const auto usable = [&](const std::optional<TaskRow>& task) {
        return task && (task->state == TaskState::done
                            ? blobs_->has(task->result.result)
                            : task->state == TaskState::pending && tasks_.contains(task->id));
    };
    // One that asks for the exact result serves as well: better than to bake the sector twice.
    auto exact_task = database_->task_by_key(task_key(content, exact, planned.sector));
    if (!exact_task)
        return tl::unexpected(exact_task.error());
    if (usable(*exact_task))
        return **exact_task;
    auto known = database_->task_by_key(task_key(content, job.settings, planned.sector));
    if (!known)
        return tl::unexpected(known.error());
    if (usable(*known))
        return **known;
    TaskRow row;
    if (*known)
        row = std::move(**known);
    row.key = task_key(content, job.settings, planned.sector);
    row.sector = planned.sector;
    row.settings = job.settings;
    // Asked for anew, or again after a failure or a loss: from the map that was just submitted.
    row.manifest = job.manifest;
    row.state = planned.reused ? TaskState::done : TaskState::pending;
    row.result = planned.reused.value_or(BakeAnswer{});
    row.bound = planned.bound;
    row.failed_attempts = 0;
    row.error.clear();
    if (auto written = row.id != 0 ? database_->update_task(row) : database_->insert_task(row); !written)
        return tl::unexpected(written.error());
    return row;
}

std::optional<BakeRequest> Farm::next_task() {
    const std::lock_guard lock(mutex_);
    while (!waiting_.empty()) {
        const auto found = tasks_.find(waiting_.front());
        waiting_.pop_front();
        // Queued twice by two jobs, or its job was cancelled.
        if (found == tasks_.end() || found->second.running || found->second.row.state != TaskState::pending)
            continue;
        Task& task = found->second;
        task.running = true;
        for (std::int64_t id : task.jobs) {
            Job& job = jobs_.at(id);
            if (!job.started)
                job.started = Clock::now();
        }
        BakeRequest request{static_cast<std::uint64_t>(task.row.id),
                            task.row.manifest,
                            task.row.sector,
                            task.row.settings,
                            {}};
        if (task.earlier)
            request.earlier = digests_of(*task.earlier);
        return request;
    }
    return std::nullopt;
}

void Farm::task_finished(std::int64_t id, int failed_attempts, const Outcome& outcome) {
    const std::lock_guard lock(mutex_);
    const auto found = tasks_.find(id);
    if (found == tasks_.end())
        return;
    Task& task = found->second;
    task.running = false;
    task.row.failed_attempts = failed_attempts;
    if (const auto* baked = std::get_if<BakeAnswer>(&outcome)) {
        task.row.state = TaskState::done;
        task.row.result = *baked;
        task.row.bound = baked->bound;
        if (task.earlier)
            task.row.result.seconds = task.earlier->seconds;
    } else {
        const auto* failure = std::get_if<FailureAnswer>(&outcome);
        task.row.state = TaskState::failed;
        task.row.error =
            failure != nullptr ? failure->sentence : "the worker gave an answer to another question";
        spdlog::error("sector ({}, {}): {}", task.row.sector.i, task.row.sector.j, task.row.error);
    }
    if (auto updated = database_->update_task(task.row); !updated) {
        // The result is in the store but not in the books: after a restart the sector is baked again.
        spdlog::error("{}", updated.error().message);
    }
    // After the task, which holds it while its jobs run.
    if (task.row.state == TaskState::done)
        keep_result(task.row);
    const std::vector<std::int64_t> jobs = task.jobs;
    const TaskRow row = task.row;
    for (std::int64_t job_id : jobs) {
        Job& job = jobs_.at(job_id);
        if (row.state == TaskState::done) {
            ++job.counts.done;
            ++job.baked;
            job.row.largest_bound = std::max(job.row.largest_bound, row.bound);
            job.counts.probes += row.result.probes;
            job.rays += row.result.rays;
        } else {
            ++job.counts.failed;
        }
        end_job_if_complete(job);
        changed(job);
    }
    if (jobs.empty())
        tasks_.erase(id);
}

// Without it the file is still there for its job; only no later one finds it.
void Farm::keep_result(const TaskRow& task) {
    const BakeAnswer& baked = task.result;
    ResultRow row{0, task.sector, reuse::results_key(task.settings), baked};
    const auto kept = database_->transaction([&]() -> Result<void> {
        if (auto inserted = database_->insert_result(row); !inserted)
            return inserted;
        return database_->count(0, 0, 1);
    });
    if (!kept) {
        spdlog::error("{}", kept.error().message);
        return;
    }
    cache_bytes_ += baked.size_bytes + baked.footprint_bytes;
    if (cache_bytes_ <= options_.cache_bytes)
        return;
    // Some more than needed, so that not every sector has to wait for this.
    if (auto shrunk = shrink_cache(options_.cache_bytes / 10 * 9); !shrunk)
        spdlog::error("{}", shrunk.error().message);
}

Result<void> Farm::shrink_cache(std::int64_t most_bytes) {
    constexpr std::size_t batch = 256;
    std::int64_t removed = 0;
    while (cache_bytes_ > most_bytes) {
        const auto rows = database_->idle_results(batch);
        if (!rows)
            return tl::unexpected(rows.error());
        if (rows->empty())
            break;  // what is left is needed
        std::vector<Digest> blobs;
        const auto done = database_->transaction([&]() -> Result<void> {
            for (const ResultRow& row : *rows) {
                if (cache_bytes_ <= most_bytes)
                    break;
                if (auto gone = database_->remove_result(row.id); !gone)
                    return gone;
                cache_bytes_ -= row.result.size_bytes + row.result.footprint_bytes;
                blobs.insert(blobs.end(), {row.result.result, row.result.footprint, row.result.inventory});
                ++removed;
            }
            return {};
        });
        if (!done)
            return done;
        // The files after the rows: a row without its file would be a result that is lost.
        std::ranges::sort(blobs);
        const auto again = std::ranges::unique(blobs);
        blobs.erase(again.begin(), again.end());
        for (const Digest& blob : blobs) {
            const auto needed = database_->is_needed(blob);
            if (!needed)
                return tl::unexpected(needed.error());
            if (!*needed)
                blobs_->remove(blob);
        }
    }
    if (removed > 0)
        spdlog::info("{} results left the cache, {} bytes are in it", removed, cache_bytes_);
    return {};
}

Result<CacheView> Farm::cache_view() {
    const auto counts = database_->cache_counts();
    if (!counts)
        return tl::unexpected(counts.error());
    return CacheView{*counts, options_.cache_bytes};
}

Result<CacheView> Farm::cache() {
    const std::lock_guard lock(mutex_);
    return cache_view();
}

Result<CacheView> Farm::clear_cache() {
    const std::lock_guard lock(mutex_);
    if (auto shrunk = shrink_cache(-1); !shrunk)
        return tl::unexpected(shrunk.error());
    return cache_view();
}

void Farm::end_job_if_complete(Job& job) {
    if (job.row.state != JobState::running || job.counts.done + job.counts.failed < job.counts.total)
        return;
    if (job.counts.failed == 0) {
        end_job(job, JobState::succeeded, "");
        return;
    }
    const auto first = std::find_if(job.tasks.begin(), job.tasks.end(), [&](std::int64_t id) {
        return tasks_.at(id).row.state == TaskState::failed;
    });
    const TaskRow& row = tasks_.at(*first).row;
    end_job(job,
            JobState::failed,
            fmt::format("{} of {} sectors failed; sector ({}, {}): {}",
                        job.counts.failed,
                        job.counts.total,
                        row.sector.i,
                        row.sector.j,
                        row.error));
}

void Farm::end_job(Job& job, JobState state, std::string error) {
    job.row.state = state;
    job.row.error = std::move(error);
    job.row.ended_seconds = unix_seconds();
    if (auto updated = database_->update_job(job.row); !updated)
        spdlog::error("{}", updated.error().message);
    for (std::int64_t id : job.tasks) {
        const auto found = tasks_.find(id);
        if (found == tasks_.end())
            continue;
        std::erase(found->second.jobs, job.row.id);
        if (found->second.jobs.empty() && !found->second.running)
            tasks_.erase(found);
    }
    job.tasks.clear();
    spdlog::info("job {} {}",
                 job.row.id,
                 state == JobState::succeeded   ? "succeeded"
                 : state == JobState::cancelled ? "was cancelled"
                                                : "failed: " + job.row.error);
    changed(job);
}

void Farm::changed(Job& job) {
    ++job.version;
    job_changed_.notify_all();
}

Result<Farm::Job*> Farm::find_job(std::int64_t id) {
    const auto found = jobs_.find(id);
    if (found == jobs_.end())
        return fail(ErrorCode::not_found, fmt::format("there is no job {}", id));
    return &found->second;
}

Result<JobView> Farm::view_of(const Job& job) {
    JobView view{job.row, job.counts, job.rays, 0, 0, job.version, job.warnings};
    if (job.row.state != JobState::running) {
        const auto counts = database_->job_counts(job.row.id);
        if (!counts)
            return tl::unexpected(counts.error());
        view.counts = *counts;
        constexpr std::size_t most_warnings = 20;
        auto warnings = database_->job_warnings(job.row.id, most_warnings);
        if (!warnings)
            return tl::unexpected(warnings.error());
        view.warnings.insert(view.warnings.end(), warnings->begin(), warnings->end());
        return view;
    }
    if (job.started && job.baked > 0) {
        const double seconds = std::chrono::duration<double>(Clock::now() - *job.started).count();
        view.rays_per_second = static_cast<double>(job.rays) / seconds;
        const std::int64_t left = job.counts.total - job.counts.done - job.counts.failed;
        view.seconds_left = seconds / static_cast<double>(job.baked) * static_cast<double>(left);
    }
    return view;
}

Result<JobView> Farm::get_job(std::int64_t id) {
    const std::lock_guard lock(mutex_);
    const auto job = find_job(id);
    if (!job)
        return tl::unexpected(job.error());
    return view_of(**job);
}

Result<std::vector<JobView>> Farm::list_jobs(std::int64_t before, std::size_t count) {
    const std::lock_guard lock(mutex_);
    std::vector<JobView> views;
    for (auto entry = std::make_reverse_iterator(jobs_.lower_bound(before));
         entry != jobs_.rend() && views.size() < count;
         ++entry) {
        auto view = view_of(entry->second);
        if (!view)
            return tl::unexpected(view.error());
        views.push_back(std::move(*view));
    }
    return views;
}

Result<JobView> Farm::cancel_job(std::int64_t id) {
    const std::lock_guard lock(mutex_);
    const auto job = find_job(id);
    if (!job)
        return tl::unexpected(job.error());
    if ((*job)->row.state == JobState::running)
        end_job(**job, JobState::cancelled, "");
    return view_of(**job);
}

Result<JobView> Farm::wait_for_change(std::int64_t id,
                                      std::uint64_t seen,
                                      std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    const auto job = find_job(id);
    if (!job)
        return tl::unexpected(job.error());
    // Jobs are never removed, and a map keeps its elements in place.
    job_changed_.wait_for(lock, patience, [&] { return (*job)->version > seen; });
    return view_of(**job);
}

Result<std::vector<SectorView>> Farm::list_sectors(std::int64_t id, std::int64_t first, std::int64_t count) {
    const std::lock_guard lock(mutex_);
    if (auto job = find_job(id); !job)
        return tl::unexpected(job.error());
    auto rows = database_->job_tasks(id, first, count);
    if (!rows)
        return tl::unexpected(rows.error());
    std::vector<SectorView> views;
    for (TaskRow& row : *rows) {
        const auto task = tasks_.find(row.id);
        const bool running = task != tasks_.end() && task->second.running;
        views.push_back({std::move(row), running});
    }
    return views;
}

Result<SectorView> Farm::get_sector(std::int64_t id, map::SectorCoordinate sector) {
    const std::lock_guard lock(mutex_);
    if (auto job = find_job(id); !job)
        return tl::unexpected(job.error());
    auto row = database_->job_task(id, sector);
    if (!row)
        return tl::unexpected(row.error());
    if (!*row)
        return fail(ErrorCode::not_found,
                    fmt::format("job {} has no sector ({}, {})", id, sector.i, sector.j));
    const auto task = tasks_.find((*row)->id);
    const bool running = task != tasks_.end() && task->second.running;
    return SectorView{std::move(**row), running};
}

}  // namespace drtv::farm
