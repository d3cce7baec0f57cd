#include "bakerd/farm/job_table.h"

#include "bakerd/farm/clock.h"
#include "bakerd/farm/job_columns.h"

#include <fmt/format.h>

#include <algorithm>

namespace drtv::farm {

namespace {

template <class Row>
void write_row(SQLite::Statement& statement, const Row& row) {
    RowBinder binder(statement);
    columns(binder, row);
    statement.exec();
}

template <class Row>
Checked<Row> read_row(SQLite::Statement& statement) {
    Checked<Row> checked;
    RowReader reader(statement);
    columns(reader, checked.row);
    checked.sound = reader.sound();
    return checked;
}

// Where the id follows the columns and their soundness.
Checked<JobRow> read_job(SQLite::Statement& statement) {
    Checked<JobRow> job = read_row<JobRow>(statement);
    job.row.id = statement.getColumn(statement.getColumnCount() - 1).getInt64();
    return job;
}

std::vector<Checked<JobSectorRow>> read_sectors(SQLite::Statement& statement) {
    std::vector<Checked<JobSectorRow>> rows;
    while (statement.executeStep())
        rows.push_back(read_row<JobSectorRow>(statement));
    return rows;
}

std::string first_failure(Connection& connection, const JobRow& job) {
    SQLite::Statement& statement = connection.statement(
        select_from<JobSectorRow>("job_sector", "WHERE job = ? AND state = ? ORDER BY j, i LIMIT 1"));
    statement.bind(1, job.id);
    statement.bind(2, static_cast<std::int64_t>(SectorState::failed));
    if (!statement.executeStep())
        return "";
    const JobSectorRow sector = read_row<JobSectorRow>(statement).row;
    // Most sentences say which one.
    const std::string which = fmt::format("sector ({}, {})", sector.sector.i, sector.sector.j);
    const bool named = sector.error.starts_with(which);
    return fmt::format("{} of {} sectors failed; {}{}",
                       job.sectors_failed,
                       job.sectors_total,
                       named ? "" : which + ": ",
                       sector.error);
}

}  // namespace

JobSectorRow reused_row(std::int64_t job,
                        map::SectorCoordinate sector,
                        const worker::SectorResult& result,
                        float bound) {
    JobSectorRow row;
    row.job = job;
    row.sector = sector;
    row.state = SectorState::done;
    row.origin = bound > 0 ? SectorOrigin::near_hit : SectorOrigin::hit;
    row.file = result.blobs.file;
    row.file_bytes = result.file_bytes;
    row.probes = result.probes;
    row.rays = result.rays;
    row.bound = bound;
    row.warnings = result.warnings;
    row.numbers = result.numbers;
    return row;
}

JobSectorRow baked_row(std::int64_t job, map::SectorCoordinate sector, const worker::SectorResult& result) {
    JobSectorRow row = reused_row(job, sector, result, result.bound);
    row.origin = SectorOrigin::baked;
    row.stages = result.stages;
    return row;
}

void insert_job(Connection& connection, JobRow& job) {
    // What is left of an attempt that failed.
    if (!job.request_id.empty())
        remove_unfinished_jobs(connection, job.request_id);
    job.state = JobState::creating;
    write_row(connection.statement(insert_into<JobRow>("job")), job);
    job.id = connection.last_id();
}

void insert_sectors(Connection& connection, std::span<const JobSectorRow> sectors) {
    for (const JobSectorRow& sector : sectors)
        write_row(connection.statement(insert_into<JobSectorRow>("job_sector")), sector);
}

void update_job(Connection& connection, const JobRow& job) {
    SQLite::Statement& statement = connection.statement(update<JobRow>("job", "WHERE id = :id"));
    statement.bind(":id", job.id);
    write_row(statement, job);
}

void replace_sector(Connection& connection, const JobSectorRow& sector) {
    SQLite::Statement& remove =
        connection.statement("DELETE FROM job_sector WHERE job = ? AND i = ? AND j = ?");
    remove.bind(1, sector.job);
    remove.bind(2, sector.sector.i);
    remove.bind(3, sector.sector.j);
    remove.exec();
    insert_sectors(connection, {&sector, 1});
}

std::optional<JobRow> record_sector(Connection& connection, const JobSectorRow& sector) {
    std::optional<Checked<JobRow>> found = find_job(connection, sector.job);
    if (!found || !found->sound || found->row.state != JobState::running)
        return std::nullopt;
    JobRow& job = found->row;
    const auto known = sector_of_job(connection, sector.job, sector.sector);
    const bool is_sound = known && known->sound;
    if (is_sound && known->row.state != SectorState::waiting)
        return std::move(job);  // it was counted already
    JobSectorRow row = sector;
    row.cause = is_sound ? known->row.cause : "";
    replace_sector(connection, row);
    if (sector.state == SectorState::done) {
        ++job.sectors_done;
        job.probes += sector.probes;
        job.largest_bound = std::max(job.largest_bound, sector.bound);
    } else {
        ++job.sectors_failed;
    }
    end_if_complete(connection, job);
    update_job(connection, job);
    return std::move(job);
}

void end_if_complete(Connection& connection, JobRow& job) {
    if (job.sectors_done + job.sectors_failed < job.sectors_total)
        return;
    job.state = job.sectors_failed == 0 ? JobState::succeeded : JobState::failed;
    if (job.sectors_failed > 0)
        job.error = first_failure(connection, job);
    job.ended_ms = unix_milliseconds();
}

std::optional<Checked<JobRow>> find_job(Connection& connection, std::int64_t id) {
    SQLite::Statement& statement = connection.statement(select_from<JobRow>("job", "WHERE id = ?", ", id"));
    statement.bind(1, id);
    if (!statement.executeStep())
        return std::nullopt;
    return read_job(statement);
}

std::vector<Checked<JobRow>> all_jobs(Connection& connection) {
    SQLite::Statement& statement = connection.statement(select_from<JobRow>("job", "ORDER BY id", ", id"));
    std::vector<Checked<JobRow>> jobs;
    while (statement.executeStep())
        jobs.push_back(read_job(statement));
    return jobs;
}

void remove_job(Connection& connection, std::int64_t id) {
    for (const char* sql : {"DELETE FROM job_sector WHERE job = ?", "DELETE FROM job WHERE id = ?"}) {
        SQLite::Statement& remove = connection.statement(sql);
        remove.bind(1, id);
        remove.exec();
    }
}

void remove_unfinished_jobs(Connection& connection, const std::string& request_id) {
    SQLite::Statement& statement =
        connection.statement("SELECT id FROM job WHERE state = ?1 AND (?2 = '' OR request_id = ?2)");
    statement.bind(1, static_cast<std::int64_t>(JobState::creating));
    statement.bind(2, request_id);
    std::vector<std::int64_t> unfinished;
    while (statement.executeStep())
        unfinished.push_back(statement.getColumn(0).getInt64());
    for (const std::int64_t id : unfinished)
        remove_job(connection, id);
}

std::vector<Checked<JobSectorRow>> sectors_of_job(Connection& connection,
                                                  std::int64_t job,
                                                  std::optional<map::SectorCoordinate> after,
                                                  std::int64_t count) {
    SQLite::Statement& statement = connection.statement(
        select_from<JobSectorRow>("job_sector", "WHERE job = ? AND (j, i) > (?, ?) ORDER BY j, i LIMIT ?"));
    statement.bind(1, job);
    statement.bind(2, after ? after->j : INT32_MIN);
    statement.bind(3, after ? after->i : INT32_MIN);
    statement.bind(4, count);
    return read_sectors(statement);
}

std::optional<Checked<JobSectorRow>> sector_of_job(Connection& connection,
                                                   std::int64_t job,
                                                   map::SectorCoordinate sector) {
    SQLite::Statement& statement =
        connection.statement(select_from<JobSectorRow>("job_sector", "WHERE job = ? AND i = ? AND j = ?"));
    statement.bind(1, job);
    statement.bind(2, sector.i);
    statement.bind(3, sector.j);
    auto rows = read_sectors(statement);
    return rows.empty() ? std::nullopt : std::optional(std::move(rows.front()));
}

std::vector<std::string> warnings_of_job(Connection& connection, std::int64_t job, std::size_t max) {
    SQLite::Statement& statement = connection.statement(
        "SELECT warnings FROM job_sector WHERE warnings != '' AND job = ? ORDER BY j, i LIMIT ?");
    // Many sectors may say the same: some more rows are looked at than there can be sentences.
    statement.bind(1, job);
    statement.bind(2, static_cast<std::int64_t>(16 * max));
    std::vector<std::string> warnings;
    while (warnings.size() < max && statement.executeStep()) {
        for (std::string& sentence : split(statement.getColumn(0).getString())) {
            if (warnings.size() < max && std::ranges::find(warnings, sentence) == warnings.end())
                warnings.push_back(std::move(sentence));
        }
    }
    return warnings;
}

}  // namespace drtv::farm
