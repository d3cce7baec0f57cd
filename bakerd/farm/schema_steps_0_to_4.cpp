#include "bakerd/farm/schema_steps.h"

namespace drtv::farm {

std::array<const char*, 5> schema_steps_0_to_4() {
    return {
        R"sql(
CREATE TABLE map (manifest TEXT PRIMARY KEY, summary TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE job (
  id INTEGER PRIMARY KEY AUTOINCREMENT, request_id TEXT UNIQUE, manifest TEXT NOT NULL, preset TEXT NOT NULL,
  settings TEXT NOT NULL, overrides TEXT NOT NULL, region TEXT NOT NULL, state INTEGER NOT NULL,
  error TEXT NOT NULL, sectors_cached INTEGER NOT NULL, created INTEGER NOT NULL, ended INTEGER NOT NULL);
CREATE TABLE task (
  id INTEGER PRIMARY KEY, key TEXT UNIQUE NOT NULL, manifest TEXT NOT NULL, i INTEGER NOT NULL,
  j INTEGER NOT NULL, settings TEXT NOT NULL, state INTEGER NOT NULL, failed_attempts INTEGER NOT NULL,
  result TEXT NOT NULL, size INTEGER NOT NULL, probes INTEGER NOT NULL, rays INTEGER NOT NULL,
  error TEXT NOT NULL);
CREATE TABLE job_task (job INTEGER NOT NULL, task INTEGER NOT NULL, PRIMARY KEY (job, task)) WITHOUT ROWID;
)sql",
        // Warnings of sectors.
        "ALTER TABLE task ADD COLUMN warnings TEXT NOT NULL DEFAULT '';",
        // Results of other maps.
        R"sql(
ALTER TABLE task ADD COLUMN bound REAL NOT NULL DEFAULT 0;
ALTER TABLE job ADD COLUMN sectors_near INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job ADD COLUMN largest_bound REAL NOT NULL DEFAULT 0;
CREATE TABLE result (
  id INTEGER PRIMARY KEY, i INTEGER NOT NULL, j INTEGER NOT NULL, settings_key TEXT NOT NULL,
  file TEXT NOT NULL, size INTEGER NOT NULL, probes INTEGER NOT NULL, rays INTEGER NOT NULL,
  warnings TEXT NOT NULL, footprint TEXT NOT NULL, inventory TEXT NOT NULL, footprint_size INTEGER NOT NULL,
  seconds REAL NOT NULL, used INTEGER NOT NULL);
CREATE INDEX result_of_sector ON result (i, j, settings_key, used);
CREATE INDEX result_by_use ON result (used);
CREATE INDEX result_of_file ON result (file);
CREATE INDEX result_of_footprint ON result (footprint);
CREATE INDEX result_of_inventory ON result (inventory);
CREATE TABLE counter (name TEXT PRIMARY KEY, value INTEGER NOT NULL) WITHOUT ROWID;
INSERT INTO counter VALUES ('hits', 0), ('near_hits', 0), ('baked', 0), ('uses', 0);
)sql",
        // Records of results are of another kind since: none of before can be assessed. They are found no
        // more, and leave the cache in their time.
        R"sql(
UPDATE result SET settings_key = '';
ALTER TABLE result ADD COLUMN bound REAL NOT NULL DEFAULT 0;
)sql",
        // Typed columns instead of JSON, each job with sectors of its own, results as the only cache, sums
        // over rows.
        R"sql(
ALTER TABLE map RENAME TO map_4;
CREATE TABLE map (
  manifest TEXT PRIMARY KEY, content TEXT NOT NULL, inventory TEXT NOT NULL, sector_count INTEGER NOT NULL,
  object_count INTEGER NOT NULL, triangle_count INTEGER NOT NULL, warnings TEXT NOT NULL, sum INTEGER NOT NULL)
  WITHOUT ROWID;
CREATE TABLE map_sector (
  manifest TEXT NOT NULL, position INTEGER NOT NULL, i INTEGER NOT NULL, j INTEGER NOT NULL, sum INTEGER NOT NULL,
  PRIMARY KEY (manifest, position)) WITHOUT ROWID;
INSERT OR IGNORE INTO map
  SELECT manifest, json_extract(summary, '$.content'), coalesce(json_extract(summary, '$.inventory'), ''),
    json_array_length(summary, '$.sectors'), json_extract(summary, '$.objects'), json_extract(summary, '$.triangles'),
    coalesce((SELECT group_concat(value, char(10)) FROM json_each(summary, '$.warnings')), ''), 0
  FROM map_4 WHERE json_valid(summary);
INSERT OR IGNORE INTO map_sector
  SELECT manifest, sector.key, json_extract(sector.value, '$[0]'), json_extract(sector.value, '$[1]'), 0
  FROM map_4, json_each(map_4.summary, '$.sectors') AS sector WHERE json_valid(summary);

ALTER TABLE job RENAME TO job_4;
CREATE TABLE job (
  id INTEGER PRIMARY KEY AUTOINCREMENT, request_id TEXT NOT NULL, manifest TEXT NOT NULL, inventory TEXT NOT NULL,
  preset TEXT NOT NULL, rays INTEGER NOT NULL, bounces INTEGER NOT NULL, reach_m REAL NOT NULL,
  min_distance_m REAL NOT NULL, error_asked REAL NOT NULL, local_transfer INTEGER NOT NULL,
  local_bounces INTEGER NOT NULL, local_rays INTEGER NOT NULL, tolerance REAL NOT NULL,
  x0 REAL, y0 REAL, x1 REAL, y1 REAL, state INTEGER NOT NULL, error TEXT NOT NULL, sectors_total INTEGER NOT NULL,
  sectors_done INTEGER NOT NULL, sectors_failed INTEGER NOT NULL, sectors_cached INTEGER NOT NULL,
  sectors_near INTEGER NOT NULL, probes INTEGER NOT NULL, largest_bound REAL NOT NULL, created_ms INTEGER NOT NULL,
  ended_ms INTEGER NOT NULL, sum INTEGER NOT NULL);
CREATE UNIQUE INDEX job_of_request ON job (request_id) WHERE request_id != '';
CREATE TABLE job_override (
  job INTEGER NOT NULL, key TEXT NOT NULL, value TEXT NOT NULL, sum INTEGER NOT NULL, PRIMARY KEY (job, key))
  WITHOUT ROWID;
CREATE TABLE job_sector (
  job INTEGER NOT NULL, i INTEGER NOT NULL, j INTEGER NOT NULL, state INTEGER NOT NULL, file TEXT NOT NULL,
  file_bytes INTEGER NOT NULL, probes INTEGER NOT NULL, rays INTEGER NOT NULL, bound REAL NOT NULL,
  warnings TEXT NOT NULL, failed_attempts INTEGER NOT NULL, error TEXT NOT NULL, sum INTEGER NOT NULL,
  PRIMARY KEY (job, j, i)) WITHOUT ROWID;
CREATE INDEX job_sector_of_file ON job_sector (file);
CREATE INDEX job_sector_with_warnings ON job_sector (job, j, i) WHERE warnings != '';
INSERT INTO job_sector
  SELECT job_task.job, i, j, state, result, size, probes, rays, bound, warnings, failed_attempts, error, 0
  FROM job_task JOIN task ON task.id = job_task.task;
INSERT OR IGNORE INTO job
  SELECT id, coalesce(request_id, ''), manifest, coalesce((SELECT inventory FROM map WHERE manifest = job_4.manifest), ''),
    preset, json_extract(settings, '$.rays'), json_extract(settings, '$.bounces'), json_extract(settings, '$.reach'),
    json_extract(settings, '$.min_distance'), coalesce(json_extract(settings, '$.error'), 0),
    coalesce(json_extract(settings, '$.lprt'), 0), coalesce(json_extract(settings, '$.lprt_bounces'), 2),
    coalesce(json_extract(settings, '$.lprt_rays'), 1024), coalesce(json_extract(settings, '$.tolerance'), 0),
    iif(region = '', NULL, json_extract(region, '$[0]')), iif(region = '', NULL, json_extract(region, '$[1]')),
    iif(region = '', NULL, json_extract(region, '$[2]')), iif(region = '', NULL, json_extract(region, '$[3]')),
    state, error, 0, 0, 0, sectors_cached, sectors_near, 0, largest_bound, created * 1000, ended * 1000, 0
  FROM job_4 WHERE json_valid(settings) AND (region = '' OR json_valid(region));
DELETE FROM job_sector WHERE job NOT IN (SELECT id FROM job);
UPDATE job SET
  sectors_total = (SELECT count(*) FROM job_sector WHERE job = job.id),
  sectors_done = (SELECT count(*) FROM job_sector WHERE job = job.id AND state = 1),
  sectors_failed = (SELECT count(*) FROM job_sector WHERE job = job.id AND state = 2),
  probes = (SELECT coalesce(sum(probes), 0) FROM job_sector WHERE job = job.id AND state = 1);
INSERT INTO job_override
  SELECT job_4.id, entry.key, entry.value, 0 FROM job_4, json_each(job_4.overrides) AS entry WHERE json_valid(overrides)
    AND job_4.id IN (SELECT id FROM job);

ALTER TABLE result RENAME TO result_4;
DROP INDEX result_of_sector;
DROP INDEX result_by_use;
DROP INDEX result_of_file;
DROP INDEX result_of_footprint;
DROP INDEX result_of_inventory;
CREATE TABLE result (
  id INTEGER PRIMARY KEY, i INTEGER NOT NULL, j INTEGER NOT NULL, results_key TEXT NOT NULL, file TEXT NOT NULL,
  footprint TEXT NOT NULL, inventory TEXT NOT NULL, file_bytes INTEGER NOT NULL, footprint_bytes INTEGER NOT NULL,
  probes INTEGER NOT NULL, rays INTEGER NOT NULL, warnings TEXT NOT NULL, seconds REAL NOT NULL,
  bound REAL NOT NULL, sum INTEGER NOT NULL, used INTEGER NOT NULL);
INSERT INTO result
  SELECT id, i, j, settings_key, file, footprint, inventory, size, footprint_size, probes, rays, warnings, seconds,
    bound, 0, used FROM result_4;
CREATE INDEX result_of_sector ON result (i, j, results_key, used);
CREATE INDEX result_by_use ON result (used);
CREATE INDEX result_of_file ON result (file);
CREATE INDEX result_of_footprint ON result (footprint);
CREATE INDEX result_of_inventory ON result (inventory);
CREATE TABLE hold (
  result INTEGER NOT NULL, inventory TEXT NOT NULL, bound REAL NOT NULL, sum INTEGER NOT NULL,
  PRIMARY KEY (result, inventory)) WITHOUT ROWID;
INSERT INTO hold SELECT id, inventory, bound, 0 FROM result WHERE results_key != '';
INSERT OR IGNORE INTO hold
  SELECT result.id, map.inventory, task.bound, 0 FROM task
  JOIN map ON map.manifest = task.manifest
  JOIN result ON result.file = task.result AND result.i = task.i AND result.j = task.j
  WHERE task.state = 1 AND result.results_key != '' AND map.inventory != '';

DROP TABLE map_4;
DROP TABLE job_4;
DROP TABLE result_4;
DROP TABLE task;
DROP TABLE job_task;
UPDATE map SET sum = row_sum(manifest, content, inventory, sector_count, object_count, triangle_count, warnings);
UPDATE map_sector SET sum = row_sum(manifest, position, i, j);
UPDATE job SET sum = row_sum(request_id, manifest, inventory, preset, rays, bounces, reach_m, min_distance_m,
  error_asked, local_transfer, local_bounces, local_rays, tolerance, x0, y0, x1, y1, state, error, sectors_total,
  sectors_done, sectors_failed, sectors_cached, sectors_near, probes, largest_bound, created_ms, ended_ms);
UPDATE job_override SET sum = row_sum(job, key, value);
UPDATE job_sector SET sum = row_sum(job, i, j, state, file, file_bytes, probes, rays, bound, warnings,
  failed_attempts, error);
UPDATE result SET sum = row_sum(i, j, results_key, file, footprint, inventory, file_bytes, footprint_bytes, probes,
  rays, warnings, seconds, bound);
UPDATE hold SET sum = row_sum(result, inventory, bound);
)sql",
    };
}

}  // namespace drtv::farm
