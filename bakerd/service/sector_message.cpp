#include "bakerd/service/sector_message.h"

namespace drtv::service {
namespace {

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

}  // namespace

void fill_sector(const farm::JobSectorView& view, v1::Sector& out) {
    const farm::JobSectorRow& row = view.row;
    out.mutable_coordinate()->set_i(row.sector.i);
    out.mutable_coordinate()->set_j(row.sector.j);
    out.set_state(to_proto(view));
    out.set_failed_attempts(row.failed_attempts);
    out.set_error(row.error);
    out.set_cause(row.cause);
    out.set_node(row.node);
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

}  // namespace drtv::service
