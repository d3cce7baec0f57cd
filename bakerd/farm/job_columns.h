// The columns of jobs and of their sectors (row_codec.h).
#pragma once

#include "bakerd/farm/records.h"
#include "bakerd/farm/row_codec.h"

#include <optional>

namespace drtv::farm {

void region_columns(auto& codec, const std::optional<Region>& region) {
    const auto bound = [&](double Region::*side) {
        return region ? std::optional<double>((*region).*side) : std::nullopt;
    };
    codec("x0", bound(&Region::x0));
    codec("y0", bound(&Region::y0));
    codec("x1", bound(&Region::x1));
    codec("y1", bound(&Region::y1));
}

void region_columns(auto& codec, std::optional<Region>& region) {
    std::optional<double> x0;
    std::optional<double> y0;
    std::optional<double> x1;
    std::optional<double> y1;
    codec("x0", x0);
    codec("y0", y0);
    codec("x1", x1);
    codec("y1", y1);
    if (x0 && y0 && x1 && y1)
        region = Region{*x0, *y0, *x1, *y1};
}

void columns(auto& codec, Is<JobRow> auto& job) {
    codec("request_id", job.request_id);
    codec("manifest", job.manifest);
    codec("inventory", job.inventory);
    codec("preset", job.preset);
    codec("rays", job.settings.rays);
    codec("bounces", job.settings.bounces);
    codec("reach_m", job.settings.reach_m);
    codec("min_distance_m", job.settings.min_distance_m);
    codec("error_asked", job.settings.error);
    codec("local_transfer", job.settings.local_transfer);
    codec("local_bounces", job.settings.local_bounces);
    codec("local_rays", job.settings.local_rays);
    codec("tolerance", job.settings.tolerance);
    region_columns(codec, job.region);
    codec("state", job.state);
    codec("error", job.error);
    codec("sectors_total", job.sectors_total);
    codec("sectors_done", job.sectors_done);
    codec("sectors_failed", job.sectors_failed);
    codec("sectors_cached", job.sectors_cached);
    codec("sectors_near", job.sectors_near);
    codec("probes", job.probes);
    codec("largest_bound", job.largest_bound);
    codec("created_ms", job.created_ms);
    codec("ended_ms", job.ended_ms);
}

void columns(auto& codec, Is<JobSectorRow> auto& sector) {
    codec("job", sector.job);
    codec("i", sector.sector.i);
    codec("j", sector.sector.j);
    codec("state", sector.state);
    codec("file", sector.file);
    codec("file_bytes", sector.file_bytes);
    codec("probes", sector.probes);
    codec("rays", sector.rays);
    codec("bound", sector.bound);
    codec("warnings", sector.warnings);
    codec("failed_attempts", sector.failed_attempts);
    codec("error", sector.error);
}

}  // namespace drtv::farm
