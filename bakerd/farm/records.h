// What the farm's database keeps, as rows.
#pragma once

#include "bakerd/executor/executor.h"
#include "bakerd/farm/job_request.h"
#include "bakerd/map/digest.h"
#include "bakerd/map/ground.h"
#include "bakerd/store/manifest.h"
#include "bakerd/worker/requests.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace drtv::farm {

using bake::StageSeconds;
using map::Digest;
using worker::SectorNumbers;

// Persisted: a number never changes its meaning.
enum class JobState : std::uint8_t {
    running = 0,
    succeeded = 1,
    failed = 2,
    cancelled = 3,
    creating = 4,  // not all of its sectors are written yet: nobody knows of it
};
enum class SectorState : std::uint8_t { waiting = 0, done = 1, failed = 2 };
// Where a file comes from.
enum class SectorOrigin : std::uint8_t {
    unknown = 0,  // recorded by a bakerd that did not tell them apart
    baked = 1,
    hit = 2,       // as baking would give it
    near_hit = 3,  // off by less than the tolerance
};

struct JobRow {
    std::int64_t id = 0;
    std::string request_id;
    Digest manifest;
    Digest inventory;  // of the map
    std::string preset;
    settings::JobSettings settings;
    std::optional<JobRegion> region;
    JobState state = JobState::running;
    std::string error;
    std::int64_t sectors_total = 0;
    std::int64_t sectors_done = 0;
    std::int64_t sectors_failed = 0;
    std::int64_t sectors_cached = 0;  // hits
    std::int64_t sectors_near = 0;    // near hits
    std::int64_t probes = 0;          // of the sectors that are done
    float largest_bound = 0;          // of near hits, and of probes that others reused
    std::int64_t created_ms = 0;      // Unix time
    std::int64_t ended_ms = 0;        // 0: it has not
    executor::Priority priority = executor::Priority::interactive;
    std::string owner;        // who submitted it, as far as is known
    std::string label;        // what its owner calls it
    std::int64_t raised = 0;  // before the owner's jobs that are less so
    bool held = false;        // none of its sectors is begun
};

// A sector of a job.
struct JobSectorRow {
    std::int64_t job = 0;
    map::SectorCoordinate sector;
    SectorState state = SectorState::waiting;
    std::string cause;  // why no earlier result is as good; empty where one is
    // When done.
    SectorOrigin origin = SectorOrigin::unknown;
    Digest file;
    std::int64_t file_bytes = 0;
    std::int64_t probes = 0;
    std::int64_t rays = 0;
    float bound = 0;  // how far it may be off, with a result of another map (reuse/assessment.h)
    std::vector<std::string> warnings;
    SectorNumbers numbers;
    StageSeconds stages;  // 0 unless it was baked
    // When failed.
    int failed_attempts = 0;
    std::string error;
    // Of the task on a cluster that baked it, or failed last (executor/executor.h).
    std::string node;
    std::string log;
};

// A sector whose file is that of a result: one that was baked for it, or one that was kept.
[[nodiscard]] JobSectorRow baked_row(std::int64_t job,
                                     map::SectorCoordinate sector,
                                     const worker::SectorResult& result);
[[nodiscard]] JobSectorRow reused_row(std::int64_t job,
                                      map::SectorCoordinate sector,
                                      const worker::SectorResult& result,
                                      float bound);

// A baked sector, kept for the map of which it was baked and any other for which it still holds.
struct ResultRow {
    std::int64_t id = 0;
    map::SectorCoordinate sector;
    Digest results_key;  // reuse::results_key
    worker::SectorResult result;
};

// That a result holds for a map: no coefficient is off by more than the bound.
struct HoldRow {
    std::int64_t result = 0;
    Digest inventory;
    float bound = 0;
};

struct MapRow {
    Digest manifest;
    worker::MapSummary summary;
};

// A row, and whether it is as it was written.
template <class Row>
struct Checked {
    Row row;
    bool sound = true;
};

struct CacheCounts {
    // Kept now: files and footprints.
    std::int64_t results = 0;
    std::int64_t bytes = 0;
    // Sectors of all jobs since the database was made.
    std::int64_t hits = 0;
    std::int64_t near_hits = 0;
    std::int64_t baked = 0;
};

struct MapView {
    Digest id;
    store::Manifest manifest;
    worker::MapSummary summary;
};

}  // namespace drtv::farm
