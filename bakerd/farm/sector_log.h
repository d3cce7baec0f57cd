// What a task of a cluster printed while it baked a sector.
#pragma once

#include "bakerd/farm/sector_views.h"
#include "bakerd/store/error.h"

#include <cstdint>
#include <string>
#include <vector>

namespace drtv::farm {

struct SectorLog {
    std::string node;
    std::string file;                // within the store
    std::vector<std::string> lines;  // that name the sector; of one that failed also the last 20
};

// failed_precondition, with the reason, where no task has baked it; not_found where the file is gone.
[[nodiscard]] store::Result<SectorLog> read_sector_log(const std::string& store_folder,
                                                       std::int64_t job,
                                                       const JobSectorView& view);

}  // namespace drtv::farm
