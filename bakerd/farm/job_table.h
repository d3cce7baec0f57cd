// Jobs and their sectors in the database. A job's counts, state and files are written together, so that they
// never disagree.
#pragma once

#include "bakerd/farm/database.h"
#include "bakerd/farm/records.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drtv::farm {

// Why a job has failed whose row is not as it was written.
inline constexpr const char* damaged_row = "its row in the database is damaged: submit the job again";

// Sets `job.id`. Its state is `creating`: after it come its sectors, in any number of portions.
void insert_job(Connection& connection, JobRow& job);
void insert_sectors(Connection& connection, std::span<const JobSectorRow> sectors);

void update_job(Connection& connection, const JobRow& job);
// Whatever it was before.
void replace_sector(Connection& connection, const JobSectorRow& sector);

// What one sector of a job has come to: `sector.state` is done or failed; its cause stays. Counts it, and
// ends the job when it was the last. Gives the job as it is then; nothing when it does not run any more, or
// its row is damaged.
[[nodiscard]] std::optional<JobRow> record_sector(Connection& connection, const JobSectorRow& sector);

// The state that follows from the counts, with a sentence about the first sector that failed.
void end_if_complete(Connection& connection, JobRow& job);

[[nodiscard]] std::optional<Checked<JobRow>> find_job(Connection& connection, std::int64_t id);
// Oldest first.
[[nodiscard]] std::vector<Checked<JobRow>> all_jobs(Connection& connection);
void remove_job(Connection& connection, std::int64_t id);
// Removes jobs whose creation never ended: all, or that of a request.
void remove_unfinished_jobs(Connection& connection, const std::string& request_id = "");

// The first `count` of a job's sectors in the order of (j, i), behind `after` where it is given.
[[nodiscard]] std::vector<Checked<JobSectorRow>> sectors_of_job(
    Connection& connection,
    std::int64_t job,
    std::optional<map::SectorCoordinate> after = std::nullopt,
    std::int64_t count = INT64_MAX);
[[nodiscard]] std::optional<Checked<JobSectorRow>> sector_of_job(Connection& connection,
                                                                 std::int64_t job,
                                                                 map::SectorCoordinate sector);
// The first `max` warnings of a job's sectors, each once, in the order of (j, i).
[[nodiscard]] std::vector<std::string> warnings_of_job(Connection& connection,
                                                       std::int64_t job,
                                                       std::size_t max);

}  // namespace drtv::farm
