// The columns of jobs and of their sectors (row_codec.h).
#pragma once

#include "bakerd/farm/records.h"
#include "bakerd/farm/row_codec.h"
#include "settings/table.h"

#include <optional>
#include <string>

namespace drtv::farm {

void region_columns(auto& codec, const std::optional<JobRegion>& region) {
    const auto bound = [&](double JobRegion::*side) {
        return region ? std::optional<double>((*region).*side) : std::nullopt;
    };
    codec("x0", bound(&JobRegion::x0));
    codec("y0", bound(&JobRegion::y0));
    codec("x1", bound(&JobRegion::x1));
    codec("y1", bound(&JobRegion::y1));
}

void region_columns(auto& codec, std::optional<JobRegion>& region) {
    std::optional<double> x0;
    std::optional<double> y0;
    std::optional<double> x1;
    std::optional<double> y1;
    codec("x0", x0);
    codec("y0", y0);
    codec("x1", x1);
    codec("y1", y1);
    if (x0 && y0 && x1 && y1)
        region = JobRegion{*x0, *y0, *x1, *y1};
}

// A column for each setting, of its name and type.
void settings_columns(auto& codec, Is<settings::JobSettings> auto& settings) {
    for (const settings::Setting& setting : settings::table()) {
        const std::string column = "setting_" + std::string(setting.name);
        settings::visit_value(settings, setting, [&](auto& value) { codec(column, value); });
    }
}

void columns(auto& codec, Is<JobRow> auto& job) {
    codec("request_id", job.request_id);
    codec("manifest", job.manifest);
    codec("inventory", job.inventory);
    codec("preset", job.preset);
    settings_columns(codec, job.settings);
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
    codec("priority", job.priority);
    codec("owner", job.owner);
    codec("label", job.label);
    codec("raised", job.raised);
    codec("held", job.held);
}

void columns(auto& codec, Is<JobSectorRow> auto& sector) {
    codec("job", sector.job);
    codec("i", sector.sector.i);
    codec("j", sector.sector.j);
    codec("state", sector.state);
    codec("cause", sector.cause);
    codec("origin", sector.origin);
    codec("file", sector.file);
    codec("file_bytes", sector.file_bytes);
    codec("probes", sector.probes);
    codec("rays", sector.rays);
    codec("bound", sector.bound);
    codec("warnings", sector.warnings);
    worker::visit_values(codec, sector.numbers);
    bake::visit_values(codec, sector.stages);
    codec("failed_attempts", sector.failed_attempts);
    codec("error", sector.error);
    codec("node", sector.node);
    codec("log", sector.log);
}

}  // namespace drtv::farm
