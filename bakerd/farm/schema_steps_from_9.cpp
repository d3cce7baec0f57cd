#include "bakerd/farm/schema_steps.h"

namespace drtv::farm {

std::array<const char*, 1> schema_steps_from_9() {
    return {
        // Whose jobs they are, and in which order they go.
        R"sql(
ALTER TABLE job ADD COLUMN owner TEXT NOT NULL DEFAULT '';
ALTER TABLE job ADD COLUMN label TEXT NOT NULL DEFAULT '';
ALTER TABLE job ADD COLUMN raised INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job ADD COLUMN held INTEGER NOT NULL DEFAULT 0;
UPDATE job SET sum = row_sum(request_id, manifest, inventory, preset, setting_rays, setting_bounces, setting_reach,
    setting_min_distance, setting_error, setting_lprt, setting_lprt_bounces, setting_lprt_rays, setting_tolerance, x0,
    y0, x1, y1, state, error, sectors_total, sectors_done, sectors_failed, sectors_cached, sectors_near, probes,
    largest_bound, created_ms, ended_ms, priority, owner, label, raised, held)
  WHERE sum = row_sum(request_id, manifest, inventory, preset, setting_rays, setting_bounces, setting_reach,
    setting_min_distance, setting_error, setting_lprt, setting_lprt_bounces, setting_lprt_rays, setting_tolerance, x0,
    y0, x1, y1, state, error, sectors_total, sectors_done, sectors_failed, sectors_cached, sectors_near, probes,
    largest_bound, created_ms, ended_ms, priority);
)sql",
    };
}

}  // namespace drtv::farm
