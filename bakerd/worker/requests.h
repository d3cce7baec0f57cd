// What the daemon asks its workers, and what they answer.
#pragma once

#include "bakerd/bake/stage_seconds.h"
#include "bakerd/map/digest.h"
#include "bakerd/map/ground.h"
#include "bakerd/map/map.h"
#include "bakerd/map/survey.h"
#include "bakerd/reuse/verdict.h"
#include "settings/bake_settings.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace drtv::worker {

using map::Digest;

// A baked sector's blobs.
struct ResultBlobs {
    Digest file;
    Digest footprint;  // what the file depends on (reuse/footprint.h)
    Digest inventory;  // the map of which it was baked (reuse/inventory.h)
};

// Import a map and say what is in it.
struct InspectRequest {
    Digest manifest;
};

// Bake one sector into the store.
struct BakeRequest {
    Digest manifest;
    map::SectorCoordinate sector;
    settings::JobSettings settings;
    std::optional<ResultBlobs> earlier;  // of another map, with these settings; what holds of it is reused
};

// Say which older results of sectors hold for a map.
struct AssessRequest {
    struct Sector {
        map::SectorCoordinate sector;
        std::vector<ResultBlobs> candidates;  // the likeliest first
    };
    Digest manifest;
    settings::JobSettings settings;
    std::vector<Sector> sectors;
};

// Answer to InspectRequest.
struct MapSummary {
    Digest content;
    Digest inventory;                            // a blob
    std::vector<map::SectorCoordinate> sectors;  // with ground, by (j, i)
    map::Survey survey;
    std::vector<std::string> warnings;  // one sentence each
};

// What became of the places for probes, and how far their paths came: of a sector's file (drtv/sector.h).
struct SectorNumbers {
    std::int64_t candidates = 0;
    std::int64_t too_near = 0;  // another probe is nearer than the minimal distance, and sees the place
    std::int64_t moved_out = 0;
    std::int64_t dropped_in_solid = 0;
    std::int64_t removed_by_volume = 0;
    std::int64_t thinned = 0;
    // Relative standard errors over its probes, and how many of these ended before the error asked for.
    double error_median = 0;
    double error_p95 = 0;
    double error_max = 0;
    std::int64_t budget_ended = 0;

    bool operator==(const SectorNumbers&) const = default;
};

// Each with the name it has in messages and in the database.
void visit_values(auto& codec, auto& numbers) {
    codec("candidates", numbers.candidates);
    codec("too_near", numbers.too_near);
    codec("moved_out", numbers.moved_out);
    codec("dropped_in_solid", numbers.dropped_in_solid);
    codec("removed_by_volume", numbers.removed_by_volume);
    codec("thinned", numbers.thinned);
    codec("error_median", numbers.error_median);
    codec("error_p95", numbers.error_p95);
    codec("error_max", numbers.error_max);
    codec("budget_ended", numbers.budget_ended);
}

// Answer to BakeRequest.
struct SectorResult {
    ResultBlobs blobs;
    std::int64_t file_bytes = 0;
    std::int64_t footprint_bytes = 0;
    std::int64_t probes = 0;
    std::int64_t rays = 0;
    std::vector<std::string> warnings;  // one sentence each
    double seconds = 0;                 // that a bake from nothing takes, beside other sectors
    float bound =
        0;  // on how far it is off, where probes of another map's result were reused (reuse/assessment.h)
    SectorNumbers numbers;
    bake::StageSeconds stages;
};

// Something that is not as it was in the map of a result, with where it is and was.
struct MapChange {
    std::string what;
    map::Bounds bounds;

    bool operator==(const MapChange& other) const {
        return what == other.what && bounds.low == other.bounds.low && bounds.high == other.bounds.high;
    }
};

// Answer to AssessRequest.
struct Assessments {
    struct Sector {
        reuse::Verdict verdict = reuse::Verdict::rebake;
        std::size_t candidate = 0;  // of a rebake the one with the most to reuse, when its share is below 1
        float bound = 0;
        float share = 1;     // of its probes, that a rebake has to bake
        std::string reason;  // one sentence; empty of a hit
        std::string cause;   // that part of it which other sectors share; likewise
    };
    std::vector<Sector> sectors;        // in the order of the request
    std::vector<MapChange> changes;     // the first of them, without those that stand nowhere
    std::vector<std::string> warnings;  // of records that cannot be used, one sentence each
};

// Of maps and jobs no more than the first few warnings are kept.
inline constexpr std::size_t max_warnings = 20;

// Answer to any request that could not be done.
struct RequestFailure {
    std::string sentence;
    bool may_retry = false;  // a full disk may be better next time, a bad map will not
};

// Sent and answered under a number, in any order.
struct Request {
    std::uint64_t id = 0;
    std::variant<InspectRequest, BakeRequest, AssessRequest> what;
    std::uint8_t rank = 0;  // those that wait for a thread are begun in this order, lower ones first
};

struct Answer {
    std::uint64_t id = 0;
    std::variant<MapSummary, SectorResult, Assessments, RequestFailure> what;
};

}  // namespace drtv::worker
