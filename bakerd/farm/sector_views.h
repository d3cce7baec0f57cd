// What the database and the jobs in memory say of a job's sectors.
#pragma once

#include "bakerd/farm/job_book.h"
#include "bakerd/farm/records.h"
#include "bakerd/map/map.h"
#include "bakerd/store/error.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace drtv::farm {

class Database;

struct JobSectorView {
    JobSectorRow row;
    bool running = false;
};

// The first `count` in the order of (j, i), behind `after` where it is given.
[[nodiscard]] store::Result<std::vector<JobSectorView>> sector_views(
    Database& database,
    const JobBook& book,
    std::int64_t job,
    std::optional<map::SectorCoordinate> after,
    std::int64_t count);

// In the order asked for; fails when one is not part of the job.
[[nodiscard]] store::Result<std::vector<JobSectorView>> sector_views(
    Database& database,
    const JobBook& book,
    std::int64_t job,
    const std::vector<map::SectorCoordinate>& sectors);

}  // namespace drtv::farm
