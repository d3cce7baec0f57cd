#include "bakerd/farm/schema_steps.h"

namespace drtv::farm {

std::array<const char*, 4> schema_steps_5_to_8() {
    return {
        // A job's settings stand in columns alone, under the settings' own names.
        R"sql(
DROP TABLE job_override;
ALTER TABLE job RENAME COLUMN rays TO setting_rays;
ALTER TABLE job RENAME COLUMN bounces TO setting_bounces;
ALTER TABLE job RENAME COLUMN reach_m TO setting_reach;
ALTER TABLE job RENAME COLUMN min_distance_m TO setting_min_distance;
ALTER TABLE job RENAME COLUMN error_asked TO setting_error;
ALTER TABLE job RENAME COLUMN local_transfer TO setting_lprt;
ALTER TABLE job RENAME COLUMN local_bounces TO setting_lprt_bounces;
ALTER TABLE job RENAME COLUMN local_rays TO setting_lprt_rays;
ALTER TABLE job RENAME COLUMN tolerance TO setting_tolerance;
)sql",
        // What a map holds, in numbers. Maps of before are looked at again when they are asked for.
        R"sql(
DROP TABLE map;
DELETE FROM map_sector;
CREATE TABLE map (
  manifest TEXT PRIMARY KEY, content TEXT NOT NULL, inventory TEXT NOT NULL, sector_count INTEGER NOT NULL,
  x0 REAL NOT NULL, y0 REAL NOT NULL, z0 REAL NOT NULL, x1 REAL NOT NULL, y1 REAL NOT NULL, z1 REAL NOT NULL,
  static_objects INTEGER NOT NULL, vegetation_objects INTEGER NOT NULL, ignored_nodes INTEGER NOT NULL, triangles
  INTEGER NOT NULL, lamps INTEGER NOT NULL, suns INTEGER NOT NULL, glowing_objects INTEGER NOT NULL, probes INTEGER
  NOT NULL, interiors INTEGER NOT NULL, probe_free_volumes INTEGER NOT NULL, spacing_volumes INTEGER NOT NULL, up_m2
  REAL NOT NULL, down_m2 REAL NOT NULL,
  likeness TEXT NOT NULL, warnings TEXT NOT NULL, sum INTEGER NOT NULL) WITHOUT ROWID;
)sql",
        // What a report of a job tells of its sectors: causes, where files come from, places, errors, times.
        // Rows
        // that were not as they were written stay so.
        R"sql(
ALTER TABLE job_sector ADD COLUMN cause TEXT NOT NULL DEFAULT '';
ALTER TABLE job_sector ADD COLUMN origin INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN candidates INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN too_near INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN moved_out INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN dropped_in_solid INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN removed_by_volume INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN thinned INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN error_median REAL NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN error_p95 REAL NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN error_max REAL NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN budget_ended INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN scene_s REAL NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN placement_s REAL NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN transfer_s REAL NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN local_transfer_s REAL NOT NULL DEFAULT 0;
ALTER TABLE job_sector ADD COLUMN files_s REAL NOT NULL DEFAULT 0;
ALTER TABLE result ADD COLUMN candidates INTEGER NOT NULL DEFAULT 0;
ALTER TABLE result ADD COLUMN too_near INTEGER NOT NULL DEFAULT 0;
ALTER TABLE result ADD COLUMN moved_out INTEGER NOT NULL DEFAULT 0;
ALTER TABLE result ADD COLUMN dropped_in_solid INTEGER NOT NULL DEFAULT 0;
ALTER TABLE result ADD COLUMN removed_by_volume INTEGER NOT NULL DEFAULT 0;
ALTER TABLE result ADD COLUMN thinned INTEGER NOT NULL DEFAULT 0;
ALTER TABLE result ADD COLUMN error_median REAL NOT NULL DEFAULT 0; ALTER TABLE result ADD COLUMN error_p95 REAL NOT NULL DEFAULT 0;
ALTER TABLE result ADD COLUMN error_max REAL NOT NULL DEFAULT 0;
ALTER TABLE result ADD COLUMN budget_ended INTEGER NOT NULL DEFAULT 0;
UPDATE job_sector SET sum = row_sum(job, i, j, state, cause, origin, file, file_bytes, probes, rays, bound, warnings,
    candidates, too_near, moved_out, dropped_in_solid, removed_by_volume, thinned, error_median, error_p95, error_max,
    budget_ended, scene_s, placement_s, transfer_s, local_transfer_s, files_s, failed_attempts, error)
  WHERE sum = row_sum(job, i, j, state, file, file_bytes, probes, rays, bound, warnings, failed_attempts, error);
UPDATE result SET sum = row_sum(i, j, results_key, file, footprint, inventory, file_bytes, footprint_bytes, probes,
    rays, warnings, seconds, bound, candidates, too_near, moved_out, dropped_in_solid, removed_by_volume, thinned, error_median,
    error_p95, error_max, budget_ended)
  WHERE sum = row_sum(i, j, results_key, file, footprint, inventory, file_bytes, footprint_bytes, probes, rays,
    warnings, seconds, bound);
)sql",
        // Which jobs go first, and what a cluster's tasks printed.
        R"sql(
ALTER TABLE job ADD COLUMN priority INTEGER NOT NULL DEFAULT 1;
ALTER TABLE job_sector ADD COLUMN node TEXT NOT NULL DEFAULT '';
ALTER TABLE job_sector ADD COLUMN log TEXT NOT NULL DEFAULT '';
UPDATE job SET sum = row_sum(request_id, manifest, inventory, preset, setting_rays, setting_bounces, setting_reach,
    setting_min_distance, setting_error, setting_lprt, setting_lprt_bounces, setting_lprt_rays, setting_tolerance, x0,
    y0, x1, y1, state, error, sectors_total, sectors_done, sectors_failed, sectors_cached, sectors_near, probes,
    largest_bound, created_ms, ended_ms, priority)
  WHERE sum = row_sum(request_id, manifest, inventory, preset, setting_rays, setting_bounces, setting_reach,
    setting_min_distance, setting_error, setting_lprt, setting_lprt_bounces, setting_lprt_rays, setting_tolerance, x0,
    y0, x1, y1, state, error, sectors_total, sectors_done, sectors_failed, sectors_cached, sectors_near, probes,
    largest_bound, created_ms, ended_ms);
UPDATE job_sector SET sum = row_sum(job, i, j, state, cause, origin, file, file_bytes, probes, rays, bound, warnings,
    candidates, too_near, moved_out, dropped_in_solid, removed_by_volume, thinned, error_median, error_p95, error_max,
    budget_ended, scene_s, placement_s, transfer_s, local_transfer_s, files_s, failed_attempts, error, node, log)
  WHERE sum = row_sum(job, i, j, state, cause, origin, file, file_bytes, probes, rays, bound, warnings,
    candidates, too_near, moved_out, dropped_in_solid, removed_by_volume, thinned, error_median, error_p95, error_max,
    budget_ended, scene_s, placement_s, transfer_s, local_transfer_s, files_s, failed_attempts, error);
)sql",
    };
}

}  // namespace drtv::farm
