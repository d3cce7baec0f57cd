// What daemon and worker say to each other: one JSON object a line, requests on the worker's standard input,
// answers on its standard output, matched by id and in any order.
#pragma once

#include "bakerd/bake/settings.h"
#include "bakerd/map/digest.h"
#include "bakerd/map/ground.h"
#include "bakerd/map/map.h"
#include "bakerd/reuse/verdict.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace drtv::farm {

// Imports a map and says what is in it.
struct InspectRequest {
    std::uint64_t id = 0;
    map::Digest manifest;
};

// A result with the records it rests on.
struct ResultDigests {
    map::Digest file, footprint, inventory;  // inventory: of the map of which it was baked
};

// Bakes one sector into the store.
struct BakeRequest {
    std::uint64_t id = 0;
    map::Digest manifest;
    map::SectorCoordinate sector;
    bake::Settings settings;
    std::optional<ResultDigests>
        earlier;  // of another map, with these settings; what holds of it is taken over
};

// Asks which older results of sectors hold for a map.
struct AssessRequest {
    struct Sector {
        map::SectorCoordinate sector;
        std::vector<ResultDigests> candidates;  // the likeliest first
    };
    std::uint64_t id = 0;
    map::Digest manifest;
    bake::Settings settings;
    std::vector<Sector> sectors;
};

using WorkerRequest = std::variant<InspectRequest, BakeRequest, AssessRequest>;

struct InspectAnswer {
    map::Digest content;
    map::Digest inventory;                       // a blob (reuse/inventory.h)
    std::vector<map::SectorCoordinate> sectors;  // with ground, by (j, i)
    std::int64_t object_count = 0, triangle_count = 0;
    std::vector<std::string> warnings;
};

struct BakeAnswer {
    map::Digest result;
    std::int64_t size_bytes = 0, probes = 0, rays = 0;
    std::vector<std::string> warnings;  // one sentence each
    map::Digest footprint = {},
                inventory = {};  // blobs: what the result depends on, and the map of which it was baked
    std::int64_t footprint_bytes = 0;
    double seconds = 0;  // that a bake from nothing takes, beside other sectors
    float bound =
        0;  // on how far it is off, where probes of another map's result were taken over (assessment.h)
};

[[nodiscard]] inline ResultDigests digests_of(const BakeAnswer& result) {
    return {result.result, result.footprint, result.inventory};
}

struct AssessAnswer {
    struct Sector {
        reuse::Verdict verdict = reuse::Verdict::rebake;
        std::size_t candidate =
            0;  // of a rebake the one with the most to take over, when its share is below 1
        float bound = 0;
        float share = 1;     // of its probes, that a rebake has to bake
        std::string reason;  // one sentence; empty of a hit
    };
    // Something that is not as it was in the map of a result, with where it is and was.
    struct Change {
        std::string what;
        map::Bounds bounds;
    };
    std::vector<Sector> sectors;        // in the order of the request
    std::vector<Change> changes;        // the first of them, without those that stand nowhere
    std::vector<std::string> warnings;  // of records that cannot be used, one sentence each
};

struct FailureAnswer {
    std::string sentence;
    bool may_retry = false;  // a full disk may be better next time, a bad map will not
};

struct WorkerAnswer {
    std::uint64_t id = 0;
    std::variant<InspectAnswer, BakeAnswer, AssessAnswer, FailureAnswer> what;
};

[[nodiscard]] std::string encode(const WorkerRequest& request);
[[nodiscard]] std::string encode(const WorkerAnswer& answer);
[[nodiscard]] std::optional<WorkerRequest> decode_request(std::string_view line);
[[nodiscard]] std::optional<WorkerAnswer> decode_answer(std::string_view line);

// Settings as they stand in requests and in the database.
[[nodiscard]] std::string encode_settings(const bake::Settings& settings);
[[nodiscard]] std::optional<bake::Settings> decode_settings(std::string_view text);

}  // namespace drtv::farm
