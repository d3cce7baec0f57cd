#include "bakerd/farm/recorder.h"

#include "bakerd/farm/clock.h"
#include "bakerd/farm/job_table.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace drtv::farm {
namespace {

JobSectorRow row_of(const FinishedSector& sector, std::int64_t job) {
    JobSectorRow row;
    if (sector.end.reply)
        row = baked_row(job, sector.key.sector, *sector.end.reply);
    row.job = job;
    row.sector = sector.key.sector;
    row.failed_attempts = sector.end.failed_attempts;
    row.node = sector.end.node;
    row.log = sector.end.log;
    if (!sector.end.reply) {
        row.state = SectorState::failed;
        row.error = sector.end.reply.error().sentence;
    }
    return row;
}

// Others wait for the database meanwhile.
constexpr std::size_t max_together = 64;

void tell_end(const JobRow& job) {
    if (job.state == JobState::succeeded)
        spdlog::info("job {} succeeded", job.id);
    if (job.state == JobState::failed)
        spdlog::info("job {} failed: {}", job.id, job.error);
}

}  // namespace

Recorder::Recorder(Database& database,
                   ResultCache& cache,
                   JobBook& book,
                   std::function<void()> work_waits,
                   std::chrono::milliseconds pause)
    : database_(database),
      cache_(cache),
      book_(book),
      work_waits_(std::move(work_waits)),
      pause_(pause),
      thread_([this] { run(); }) {}

Recorder::~Recorder() {
    stop();
}

void Recorder::record(FinishedSector sector) {
    {
        const std::lock_guard lock(mutex_);
        pending_.push_back({std::move(sector), false});
    }
    changed_.notify_all();
}

void Recorder::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable())
        thread_.join();
}

void Recorder::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return stopping_ || !pending_.empty(); });
        if (pending_.empty())
            return;
        // As many as wait.
        const std::size_t count = std::min(pending_.size(), max_together);
        std::vector<Pending> several(
            std::make_move_iterator(pending_.begin()),
            std::make_move_iterator(pending_.begin() + static_cast<std::ptrdiff_t>(count)));
        pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(count));
        lock.unlock();
        // Before the sectors are recorded: after its last one a job no longer holds its files, and its client
        // would find some of them gone before they are pulled.
        if (auto kept = cache_.keep_to_limit(); !kept)
            spdlog::error("{}", kept.error().message);
        if (several.size() > 1)
            record_together(several);
        auto left = several.begin();
        while (left != several.end() && try_to_record(*left))
            ++left;
        lock.lock();
        if (left == several.end())
            continue;
        if (stopping_)
            return;  // after a restart what is left waits again
        pending_.insert(
            pending_.begin(), std::make_move_iterator(left), std::make_move_iterator(several.end()));
        changed_.wait_for(lock, pause_, [this] { return stopping_; });
    }
}

void Recorder::record_together(std::vector<Pending>& several) {
    if (!write(several))
        return;  // one of them may be why
    std::erase_if(several, [this](Pending& pending) { return leave(pending); });
}

bool Recorder::leave(Pending& pending) {
    pending.sector.jobs = book_.leave(pending.sector.end.id, pending.sector.jobs);
    return pending.sector.jobs.empty();
}

bool Recorder::try_to_record(Pending& pending) {
    FinishedSector& sector = pending.sector;
    const auto done = write(std::span(&pending, 1));
    if (!done && done.error().code == store::ErrorCode::not_found) {
        spdlog::warn("sector ({}, {}) is baked again: {}",
                     sector.key.sector.i,
                     sector.key.sector.j,
                     done.error().message);
        book_.put_back(sector.end.id);
        work_waits_();
        return true;
    }
    if (!done) {
        refuse(pending, done.error());
        return done.error().code == store::ErrorCode::data_loss;
    }
    return leave(pending) || try_to_record(pending);
}

store::Result<void> Recorder::write(std::span<Pending> several) {
    std::vector<const worker::SectorResult*> results;
    for (const Pending& pending : several) {
        if (pending.sector.end.reply)
            results.push_back(&*pending.sector.end.reply);
    }
    std::vector<Written> written;
    const auto done = cache_.commit_if_there(results, [&] {
        return database_.write([&](Connection& connection) {
            for (const Pending& pending : several)
                written.push_back(write_one(connection, pending));
        });
    });
    if (!done)
        return done;
    for (std::size_t n = 0; n < several.size(); ++n)
        tell(several[n], written[n]);
    return {};
}

Recorder::Written Recorder::write_one(Connection& connection, const Pending& pending) {
    const FinishedSector& sector = pending.sector;
    Written written;
    if (sector.end.reply && !pending.kept) {
        insert_result(connection, {0, sector.key.sector, sector.key.results_key, *sector.end.reply});
        count_sectors(connection, 0, 0, 1);
    }
    for (const std::int64_t id : sector.jobs) {
        if (auto job = record_sector(connection, row_of(sector, id)))
            written.jobs.push_back(std::move(*job));
        else if (auto known = find_job(connection, id); known && known->sound)
            written.jobs.push_back(
                std::move(known->row));  // cancelled, or a commit was kept that was called failed
        else
            written.damaged.push_back(id);
    }
    return written;
}

void Recorder::tell(Pending& pending, const Written& written) {
    const FinishedSector& sector = pending.sector;
    if (sector.end.reply && !std::exchange(pending.kept, true))
        cache_.added(*sector.end.reply);
    if (!sector.end.reply)
        spdlog::error("sector ({}, {}): {}",
                      sector.key.sector.i,
                      sector.key.sector.j,
                      sector.end.reply.error().sentence);
    for (const JobRow& job : written.jobs) {
        book_.update(job, sector.end.reply ? &*sector.end.reply : nullptr);
        if (job.state != JobState::running)
            cache_.job_ended();
        tell_end(job);
    }
    for (const std::int64_t id : written.damaged)
        fail_in_memory(id, damaged_row);
}

// After a restart it has failed in the database too.
void Recorder::fail_in_memory(std::int64_t id, const std::string& error) {
    auto view = book_.view(id);
    if (!view || view->row.state != JobState::running)
        return;
    view->row.state = JobState::failed;
    view->row.error = error;
    view->row.ended_ms = unix_milliseconds();
    book_.update(view->row);
    tell_end(view->row);
}

// A job waits for a database that is locked or full. It cannot wait for one that is damaged.
void Recorder::refuse(const Pending& pending, const store::Error& error) {
    spdlog::error("{}", error.message);
    for (const std::int64_t id : pending.sector.jobs) {
        if (error.code != store::ErrorCode::data_loss) {
            book_.warn(id, fmt::format("a baked sector waits to be written: {}", error.message));
            continue;
        }
        fail_in_memory(id, error.message);
    }
    if (error.code != store::ErrorCode::data_loss)
        return;
    // Jobs that joined meanwhile try for themselves.
    if (!book_.leave(pending.sector.end.id, pending.sector.jobs).empty()) {
        book_.put_back(pending.sector.end.id);
        work_waits_();
    }
}

}  // namespace drtv::farm
