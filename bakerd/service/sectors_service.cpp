#include "bakerd/service/file_sender.h"
#include "bakerd/service/names.h"
#include "bakerd/service/sector_message.h"
#include "bakerd/service/services.h"
#include "bakerd/store/text_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace drtv::service {
namespace {

constexpr std::int64_t default_page = 1000, max_page = 10000;

// A page's token names the sector before it: 1 + j, i as 16 bits each. 0: the first page.
constexpr std::int32_t lowest = -32768;

std::int64_t token_of(const map::SectorCoordinate& sector) {
    return std::int64_t{sector.j - lowest} * 65536 + (sector.i - lowest) + 1;
}

std::optional<map::SectorCoordinate> sector_before(std::int64_t token) {
    if (token <= 0)
        return std::nullopt;
    const std::int64_t key = std::min<std::int64_t>(token - 1, 0xFFFF'FFFF);
    return map::SectorCoordinate{static_cast<std::int32_t>(key % 65536) + lowest,
                                 static_cast<std::int32_t>(key / 65536) + lowest};
}

}  // namespace

grpc::Status SectorsService::ListSectors(grpc::ServerContext*,
                                         const v1::ListSectorsRequest* request,
                                         v1::ListSectorsResponse* response) {
    const auto job = job_from_name(request->job());
    if (!job)
        return to_status(job.error());
    const auto page = page_of(request->page_token(), request->page_size(), 0, default_page, max_page);
    if (!page)
        return to_status(page.error());
    const auto views = farm_.list_sectors(*job, sector_before(page->from), page->size + 1);
    if (!views)
        return to_status(views.error());
    const auto size = static_cast<std::size_t>(page->size);
    for (std::size_t n = 0; n < views->size() && n < size; ++n)
        fill_sector((*views)[n], *response->add_sectors());
    if (views->size() > size)
        response->set_next_page_token(std::to_string(token_of((*views)[size - 1].row.sector)));
    return grpc::Status::OK;
}

grpc::Status SectorsService::PullSectors(grpc::ServerContext*,
                                         const v1::PullSectorsRequest* request,
                                         grpc::ServerWriter<v1::PullSectorsResponse>* writer) {
    const auto job = job_from_name(request->job());
    if (!job)
        return to_status(job.error());
    FileSender sender(farm_.blobs(), *writer, request->takes_packs());
    if (request->sectors_size() == 0) {
        for (std::optional<map::SectorCoordinate> after;;) {
            const auto views = farm_.list_sectors(*job, after, default_page);
            if (!views)
                return to_status(views.error());
            for (const farm::JobSectorView& view : *views) {
                if (view.row.state == farm::SectorState::done && !sender.send(view))
                    return grpc::Status::CANCELLED;
            }
            if (views->size() < static_cast<std::size_t>(default_page))
                return sender.finish();
            after = views->back().row.sector;
        }
    }
    constexpr int at_once = 128;
    for (int from = 0; from < request->sectors_size(); from += at_once) {
        std::vector<map::SectorCoordinate> asked;
        for (int n = from; n < std::min(from + at_once, request->sectors_size()); ++n)
            asked.push_back({request->sectors(n).i(), request->sectors(n).j()});
        const auto views = farm_.get_sectors(*job, asked);
        if (!views)
            return to_status(views.error());
        for (const farm::JobSectorView& view : *views) {
            const map::SectorCoordinate& place = view.row.sector;
            if (view.row.state != farm::SectorState::done)
                return failed(grpc::StatusCode::FAILED_PRECONDITION,
                              fmt::format("sector ({}, {}) is not done", place.i, place.j));
            if (!sender.send(view))
                return grpc::Status::CANCELLED;
        }
    }
    return sender.finish();
}

// Lines are whatever a task printed; a message holds UTF-8 only.
grpc::Status SectorsService::GetSectorLog(grpc::ServerContext*,
                                          const v1::GetSectorLogRequest* request,
                                          v1::SectorLog* response) {
    const auto job = job_from_name(request->job());
    if (!job)
        return to_status(job.error());
    const auto log = farm_.sector_log(*job, {request->sector().i(), request->sector().j()});
    if (!log)
        return to_status(log.error());
    response->set_node(log->node);
    response->set_file(log->file);
    for (const std::string& line : log->lines)
        response->add_lines(store::as_utf8(line));
    return grpc::Status::OK;
}

}  // namespace drtv::service
