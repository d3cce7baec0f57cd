// A job's way into the database, and back at the start of the daemon.
#pragma once

#include "bakerd/farm/database.h"
#include "bakerd/farm/job_book.h"
#include "bakerd/farm/plan.h"
#include "bakerd/farm/records.h"
#include "bakerd/store/error.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace drtv::farm {

[[nodiscard]] tl::unexpected<store::Error> no_job(std::int64_t id);

// What is asked for, now.
[[nodiscard]] JobRow new_job(const JobRequest& request, const Digest& inventory);

// Writes a job with all its sectors, in portions, so that others are answered meanwhile; nobody knows of the
// job before all of it is there. `job` has an id then, and its counts. REQUIRES: what the plan reuses is
// pinned.
[[nodiscard]] store::Result<void> write_job(Database& database, const Plan& plan, JobRow& job);

// The sectors of a plan that have to be baked, in its order.
[[nodiscard]] std::vector<WantedSector> wanted_by(const Plan& plan);

// Makes the failed sectors of a job that has ended wait again, and tells the book. Fails where there is no
// such job or sector.
[[nodiscard]] store::Result<void> retry_job(Database& database, std::int64_t id, JobBook& book);

// Changes a running job's place in the queue. Errors: not_found; failed_precondition for one that has ended.
[[nodiscard]] store::Result<void> move_job(Database& database,
                                           std::int64_t id,
                                           JobBook& book,
                                           const std::function<void(JobRow& job)>& change);

// Tells the book of all jobs that the database has, and resumes those that were running. Rows that are not as
// they were written do not count: a sector is baked again, a job has failed.
[[nodiscard]] store::Result<void> load_jobs(Database& database, JobBook& book);

}  // namespace drtv::farm
