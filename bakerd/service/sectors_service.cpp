#include "bakerd/service/names.h"
#include "bakerd/service/services.h"

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

v1::Sector::State to_proto(const farm::JobSectorView& view) {
    if (view.running)
        return v1::Sector::RUNNING;
    switch (view.row.state) {
        case farm::SectorState::waiting:
            return v1::Sector::PENDING;
        case farm::SectorState::done:
            return v1::Sector::DONE;
        case farm::SectorState::failed:
            return v1::Sector::FAILED;
    }
    return v1::Sector::STATE_UNSPECIFIED;
}

v1::Sector::Origin to_proto(farm::SectorOrigin origin) {
    switch (origin) {
        case farm::SectorOrigin::baked:
            return v1::Sector::BAKED;
        case farm::SectorOrigin::hit:
            return v1::Sector::HIT;
        case farm::SectorOrigin::near_hit:
            return v1::Sector::NEAR_HIT;
        case farm::SectorOrigin::unknown:
            break;
    }
    return v1::Sector::ORIGIN_UNSPECIFIED;
}

// Of results that an older server recorded they are not known.
void fill_numbers(const farm::SectorNumbers& numbers, v1::Sector& out) {
    if (numbers == farm::SectorNumbers())
        return;
    v1::Placement& placement = *out.mutable_placement();
    placement.set_candidates(numbers.candidates);
    placement.set_too_near(numbers.too_near);
    placement.set_moved_out(numbers.moved_out);
    placement.set_dropped_in_solid(numbers.dropped_in_solid);
    placement.set_removed_by_volume(numbers.removed_by_volume);
    placement.set_thinned(numbers.thinned);
    v1::ReachedError& error = *out.mutable_reached_error();
    error.set_median(numbers.error_median);
    error.set_p95(numbers.error_p95);
    error.set_max(numbers.error_max);
    error.set_budget_ended(numbers.budget_ended);
}

void fill_stages(const farm::StageSeconds& stages, v1::StageSeconds& out) {
    out.set_scene(stages.scene);
    out.set_placement(stages.placement);
    out.set_transfer(stages.transfer);
    out.set_local_transfer(stages.local_transfer);
    out.set_files(stages.files);
}

void fill(const farm::JobSectorView& view, v1::Sector& out) {
    const farm::JobSectorRow& row = view.row;
    out.mutable_coordinate()->set_i(row.sector.i);
    out.mutable_coordinate()->set_j(row.sector.j);
    out.set_state(to_proto(view));
    out.set_failed_attempts(row.failed_attempts);
    out.set_error(row.error);
    out.set_cause(row.cause);
    if (row.state != farm::SectorState::done)
        return;
    out.set_sha256(to_hex(row.file));
    out.set_size_bytes(row.file_bytes);
    out.set_probes(row.probes);
    out.set_rays(row.rays);
    for (const std::string& warning : row.warnings)
        out.add_warnings(warning);
    out.set_origin(to_proto(row.origin));
    fill_numbers(row.numbers, out);
    if (row.origin == farm::SectorOrigin::baked)
        fill_stages(row.stages, *out.mutable_stages());
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
        fill((*views)[n], *response->add_sectors());
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
    std::int64_t lost = 0;
    std::string first_loss;
    const auto send_or_note = [&](const farm::JobSectorView& view) -> grpc::Status {
        grpc::Status status = send(view, *writer);
        if (status.error_code() != grpc::StatusCode::DATA_LOSS)
            return status;
        if (++lost == 1)
            first_loss = status.error_message();
        return grpc::Status::OK;
    };
    const auto end = [&]() -> grpc::Status {
        if (lost == 0)
            return grpc::Status::OK;
        const std::string more = lost > 1 ? fmt::format(" (and {} more)", lost - 1) : "";
        return failed(
            grpc::StatusCode::DATA_LOSS,
            fmt::format(
                "{}{}; submit the map again to bake {} again", first_loss, more, lost > 1 ? "them" : "it"));
    };
    if (request->sectors_size() == 0) {
        for (std::optional<map::SectorCoordinate> after;;) {
            const auto views = farm_.list_sectors(*job, after, default_page);
            if (!views)
                return to_status(views.error());
            for (const farm::JobSectorView& view : *views) {
                if (view.row.state != farm::SectorState::done)
                    continue;
                if (grpc::Status status = send_or_note(view); !status.ok())
                    return status;
            }
            if (views->size() < static_cast<std::size_t>(default_page))
                return end();
            after = views->back().row.sector;
        }
    }
    for (const v1::SectorCoordinate& coordinate : request->sectors()) {
        const auto view = farm_.get_sector(*job, {coordinate.i(), coordinate.j()});
        if (!view)
            return to_status(view.error());
        if (view->row.state != farm::SectorState::done)
            return failed(grpc::StatusCode::FAILED_PRECONDITION,
                          fmt::format("sector ({}, {}) is not done", coordinate.i(), coordinate.j()));
        if (grpc::Status status = send_or_note(*view); !status.ok())
            return status;
    }
    return end();
}

grpc::Status SectorsService::send(const farm::JobSectorView& view,
                                  grpc::ServerWriter<v1::PullSectorsResponse>& writer) {
    const auto bytes = farm_.blobs().get(view.row.file);
    if (!bytes) {
        // Where the server keeps it says nothing to a client.
        const bool is_gone = bytes.error().code == store::ErrorCode::not_found;
        return failed(grpc::StatusCode::DATA_LOSS,
                      fmt::format("the file of sector ({}, {}) is {}",
                                  view.row.sector.i,
                                  view.row.sector.j,
                                  is_gone ? "no longer kept" : "damaged"));
    }
    v1::PullSectorsResponse message;
    fill(view, *message.mutable_sector());
    // The first bytes come with the sector: most files are one message.
    for (std::size_t at = 0; at < bytes->size(); at += max_chunk_bytes) {
        message.set_data(bytes->data() + at, std::min(max_chunk_bytes, bytes->size() - at));
        if (!writer.Write(message))
            return grpc::Status::CANCELLED;
        message.clear_sector();
    }
    return grpc::Status::OK;
}

}  // namespace drtv::service
