#include "bakerd/farm/sector_views.h"

#include "bakerd/farm/database.h"
#include "bakerd/farm/job_store.h"
#include "bakerd/farm/job_table.h"

#include <fmt/format.h>

#include <utility>

namespace drtv::farm {

using store::ErrorCode;
using store::fail;
using store::Result;

namespace {

JobSectorView view_of(Checked<JobSectorRow> sector, const JobBook& book) {
    if (!sector.sound) {
        sector.row.state = SectorState::failed;
        sector.row.error = "its row in the database is damaged";
    }
    const bool running =
        sector.row.state == SectorState::waiting && book.is_running(sector.row.job, sector.row.sector);
    return {std::move(sector.row), running};
}

}  // namespace

Result<std::vector<JobSectorView>> sector_views(Database& database,
                                                const JobBook& book,
                                                std::int64_t job,
                                                std::optional<map::SectorCoordinate> after,
                                                std::int64_t count) {
    if (!book.view(job))
        return no_job(job);
    auto rows =
        database.read([&](Connection& connection) { return sectors_of_job(connection, job, after, count); });
    if (!rows)
        return tl::unexpected(rows.error());
    std::vector<JobSectorView> views;
    for (Checked<JobSectorRow>& row : *rows)
        views.push_back(view_of(std::move(row), book));
    return views;
}

Result<std::vector<JobSectorView>> sector_views(Database& database,
                                                const JobBook& book,
                                                std::int64_t job,
                                                const std::vector<map::SectorCoordinate>& sectors) {
    if (!book.view(job))
        return no_job(job);
    auto rows = database.read([&](Connection& connection) {
        std::vector<std::optional<Checked<JobSectorRow>>> read;
        for (const map::SectorCoordinate& sector : sectors)
            read.push_back(sector_of_job(connection, job, sector));
        return read;
    });
    if (!rows)
        return tl::unexpected(rows.error());
    std::vector<JobSectorView> views;
    for (std::size_t n = 0; n < sectors.size(); ++n) {
        if (!(*rows)[n])
            return fail(ErrorCode::not_found,
                        fmt::format("job {} has no sector ({}, {})", job, sectors[n].i, sectors[n].j));
        views.push_back(view_of(std::move(*(*rows)[n]), book));
    }
    return views;
}

}  // namespace drtv::farm
