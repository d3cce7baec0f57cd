#include "bakerd/farm/job_store.h"

#include "bakerd/farm/clock.h"
#include "bakerd/farm/job_table.h"
#include "bakerd/farm/result_table.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <span>

namespace drtv::farm {
namespace {

// Sectors that are written in one go while others wait.
constexpr std::size_t portion = 1000;

JobSectorRow waiting_row(std::int64_t job, map::SectorCoordinate sector, const std::string& cause) {
    JobSectorRow row;
    row.job = job;
    row.sector = sector;
    row.cause = cause;
    return row;
}

JobSectorRow row_of(const PlannedSector& planned, std::int64_t job) {
    if (!planned.reused)
        return waiting_row(job, planned.sector, planned.cause);
    JobSectorRow row = reused_row(job, planned.sector, planned.reused->result, planned.bound);
    row.cause = planned.cause;
    return row;
}

void count_reused(const PlannedSector& planned, JobRow& job) {
    if (!planned.reused)
        return;
    ++job.sectors_done;
    ++(planned.bound > 0 ? job.sectors_near : job.sectors_cached);
    job.probes += planned.reused->result.probes;
    job.largest_bound = std::max(job.largest_bound, planned.bound);
}

void write_portion(Connection& connection, std::span<const PlannedSector> sectors, JobRow& job) {
    std::vector<JobSectorRow> rows;
    for (const PlannedSector& planned : sectors) {
        rows.push_back(row_of(planned, job.id));
        count_reused(planned, job);
        if (planned.reused)
            use_result(connection, {planned.reused->id, job.inventory, planned.bound});
    }
    insert_sectors(connection, rows);
}

// What the rows say, where the job's own counts say something else, or a row does not count.
void recount(Connection& connection, std::span<Checked<JobSectorRow>> sectors, JobRow& job) {
    JobRow counted = job;
    counted.sectors_total = static_cast<std::int64_t>(sectors.size());
    counted.sectors_done = counted.sectors_failed = counted.probes = 0;
    for (Checked<JobSectorRow>& sector : sectors) {
        if (!sector.sound) {
            spdlog::warn("job {}: the row of sector ({}, {}) is damaged: it is baked again",
                         job.id,
                         sector.row.sector.i,
                         sector.row.sector.j);
            sector.row = waiting_row(job.id, sector.row.sector, "");
            replace_sector(connection, sector.row);
        }
        counted.sectors_done += sector.row.state == SectorState::done ? 1 : 0;
        counted.sectors_failed += sector.row.state == SectorState::failed ? 1 : 0;
        counted.probes += sector.row.state == SectorState::done ? sector.row.probes : 0;
    }
    job = counted;
    end_if_complete(connection, job);
    update_job(connection, job);
}

// Those that wait, in the order of baking.
std::vector<WantedSector> waiting_of(std::span<const Checked<JobSectorRow>> sectors) {
    std::vector<map::SectorCoordinate> waiting;
    for (const Checked<JobSectorRow>& sector : sectors) {
        if (sector.row.state == SectorState::waiting)
            waiting.push_back(sector.row.sector);
    }
    std::vector<WantedSector> wanted;
    for (const map::SectorCoordinate& sector : in_order_of_baking(std::move(waiting)))
        wanted.push_back({sector, std::nullopt, 0});
    return wanted;
}

void fail_damaged(Connection& connection, JobRow job, JobBook& book) {
    spdlog::warn("job {}: {}", job.id, damaged_row);
    job.state = JobState::failed;
    job.error = damaged_row;
    job.ended_ms = job.ended_ms != 0 ? job.ended_ms : unix_milliseconds();
    update_job(connection, job);
    book.add(std::move(job), {});
}

void resume(Connection& connection, JobRow job, JobBook& book) {
    std::vector<Checked<JobSectorRow>> sectors = sectors_of_job(connection, job.id);
    if (static_cast<std::int64_t>(sectors.size()) != job.sectors_total)
        return fail_damaged(connection, std::move(job), book);
    recount(connection, sectors, job);
    spdlog::info("job {} goes on: {} of {} sectors are done", job.id, job.sectors_done, job.sectors_total);
    book.add(job, waiting_of(sectors));
}

}  // namespace

tl::unexpected<store::Error> no_job(std::int64_t id) {
    return store::fail(store::ErrorCode::not_found, fmt::format("there is no job {}", id));
}

JobRow new_job(const JobRequest& request, const Digest& inventory) {
    JobRow job;
    job.request_id = request.request_id;
    job.manifest = request.manifest;
    job.inventory = inventory;
    job.preset = request.preset;
    job.settings = request.settings;
    job.region = request.region;
    job.priority = request.priority;
    job.owner = request.owner;
    job.label = request.label;
    job.created_ms = unix_milliseconds();
    return job;
}

store::Result<void> write_job(Database& database, const Plan& plan, JobRow& job) {
    job.sectors_total = static_cast<std::int64_t>(plan.sectors.size());
    auto done = database.write([&](Connection& connection) { insert_job(connection, job); });
    const std::span<const PlannedSector> sectors = plan.sectors;
    for (std::size_t first = 0; done && first < sectors.size(); first += portion) {
        const auto part = sectors.subspan(first, std::min(portion, sectors.size() - first));
        const JobRow before = job;
        done = database.write([&](Connection& connection) { write_portion(connection, part, job); });
        if (!done)
            job = before;
    }
    if (done)
        done = database.write([&](Connection& connection) {
            job.state = JobState::running;
            end_if_complete(connection, job);
            update_job(connection, job);
            count_sectors(connection, job.sectors_cached, job.sectors_near, 0);
        });
    if (done)
        spdlog::info("job {}: {} sectors, {} of them in the cache, {} nearly so",
                     job.id,
                     job.sectors_total,
                     job.sectors_cached,
                     job.sectors_near);
    // If this is refused as well, the next start removes it.
    if (!done && job.id != 0)
        static_cast<void>(database.write([&](Connection& connection) { remove_job(connection, job.id); }));
    return done;
}

std::vector<WantedSector> wanted_by(const Plan& plan) {
    std::vector<WantedSector> wanted;
    for (const PlannedSector& planned : plan.sectors) {
        // Without an earlier result the time is only a mean, perhaps of other settings.
        if (!planned.reused)
            wanted.push_back({planned.sector, planned.earlier, planned.earlier ? planned.seconds : 0});
    }
    return wanted;
}

store::Result<void> retry_job(Database& database, std::int64_t id, JobBook& book) {
    const auto view = book.view(id);
    if (!view)
        return no_job(id);
    std::optional<JobRow> reopened;
    std::vector<WantedSector> wanted;
    const auto done = database.write([&](Connection& connection) {
        auto job = find_job(connection, id);
        // What the database has written, the book may not have been told yet.
        const bool has_ended =
            job && job->row.state != JobState::running && view->row.state != JobState::running;
        if (!has_ended || !job->sound || job->row.sectors_failed == 0)
            return;
        std::vector<Checked<JobSectorRow>> sectors = sectors_of_job(connection, id);
        for (Checked<JobSectorRow>& sector : sectors) {
            if (sector.row.state != SectorState::failed)
                continue;
            sector.row = waiting_row(id, sector.row.sector, sector.row.cause);
            replace_sector(connection, sector.row);
        }
        JobRow row = job->row;
        row.state = JobState::running;
        row.error.clear();
        row.ended_ms = 0;
        recount(connection, sectors, row);
        wanted = waiting_of(sectors);
        reopened = std::move(row);
    });
    if (!done)
        return done;
    if (!reopened) {
        const char* why =
            view->row.state == JobState::running ? "it still runs" : "no sector of it has failed";
        return store::fail(store::ErrorCode::failed_precondition,
                           fmt::format("job {} cannot be retried: {}", id, why));
    }
    spdlog::info("job {} is retried: {} sectors", id, wanted.size());
    book.reopen(*reopened, wanted);
    return {};
}

store::Result<void> move_job(Database& database,
                             std::int64_t id,
                             JobBook& book,
                             const std::function<void(JobRow& job)>& change) {
    if (!book.view(id))
        return no_job(id);
    std::optional<JobRow> moved;
    const auto done = database.write([&](Connection& connection) {
        auto job = find_job(connection, id);
        if (!job || !job->sound || job->row.state != JobState::running)
            return;
        change(job->row);
        update_job(connection, job->row);
        moved = std::move(job->row);
    });
    if (!done)
        return done;
    if (!moved)
        return store::fail(store::ErrorCode::failed_precondition, fmt::format("job {} has ended", id));
    book.move(*moved);
    return {};
}

store::Result<void> load_jobs(Database& database, JobBook& book) {
    return database.write([&](Connection& connection) {
        remove_unfinished_jobs(connection);
        for (Checked<JobRow>& job : all_jobs(connection)) {
            JobRow& row = job.row;
            if (!job.sound)
                fail_damaged(connection, std::move(row), book);
            else if (row.state == JobState::running)
                resume(connection, std::move(row), book);
            else
                book.add(std::move(row), {});
        }
    });
}

}  // namespace drtv::farm
