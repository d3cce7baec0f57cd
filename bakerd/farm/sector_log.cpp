#include "bakerd/farm/sector_log.h"

#include "bakerd/store/durable_file.h"
#include "bakerd/store/text_bytes.h"

#include <fmt/format.h>

#include <string_view>

namespace drtv::farm {
namespace {

constexpr std::size_t last_lines = 20;

std::string why_none(const JobSectorView& view) {
    if (view.row.state == SectorState::waiting)
        return view.running ? "is being baked: it has a log when its task has ended" : "has not been baked";
    if (view.row.origin == SectorOrigin::hit || view.row.origin == SectorOrigin::near_hit)
        return "was not baked: an earlier result was reused";
    return "was not baked on a cluster: what was said of it stands in the daemon's own log";
}

// Tasks name the file: it must lie where theirs do.
bool is_log_of_task(std::string_view file) {
    return file.starts_with("logs/") && file.find("..") == file.npos;
}

}  // namespace

store::Result<SectorLog> read_sector_log(const std::string& store_folder,
                                         std::int64_t job,
                                         const JobSectorView& view) {
    const JobSectorRow& row = view.row;
    const std::string name = fmt::format("sector ({}, {})", row.sector.i, row.sector.j);
    if (!is_log_of_task(row.log))
        return store::fail(store::ErrorCode::failed_precondition,
                           fmt::format("{} of job {} {}", name, job, why_none(view)));
    const auto bytes = store::read_all(fmt::format("{}/{}", store_folder, row.log));
    if (!bytes)
        return store::fail(store::ErrorCode::not_found, bytes.error().message);
    SectorLog log{row.node, row.log, {}};
    const std::vector<std::string_view> lines = store::lines_of(store::text_of_bytes(*bytes));
    for (std::size_t n = 0; n < lines.size(); ++n) {
        const bool is_last = row.state == SectorState::failed && n + last_lines >= lines.size();
        if (is_last || lines[n].find(name) != std::string_view::npos)
            log.lines.emplace_back(lines[n]);
    }
    return log;
}

}  // namespace drtv::farm
