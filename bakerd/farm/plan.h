// What of a job is there already: which sectors' results hold, and which have to be baked, and why.
#pragma once

#include "bakerd/farm/blob_store.h"
#include "bakerd/farm/database.h"
#include "bakerd/farm/error.h"
#include "bakerd/farm/worker_protocol.h"

#include <optional>
#include <string>
#include <vector>

namespace drtv::farm {

struct PlannedSector {
    map::SectorCoordinate sector;
    reuse::Verdict verdict = reuse::Verdict::rebake;
    std::optional<BakeAnswer> reused;   // unless rebake
    float bound = 0;                    // of a near hit
    std::string reason;                 // one sentence; empty of a hit
    std::optional<BakeAnswer> earlier;  // of another map, of which a rebake takes over what holds
    float share = 1;                    // of its probes, that a rebake has to bake
    double seconds = 0;                 // that baking it will take, as far as is known; 0: not
    std::vector<ResultRow> candidates;  // to be assessed, the one used last first
};

struct Plan {
    std::vector<PlannedSector> sectors;  // in the order of baking
    std::vector<AssessAnswer::Change> changes;
    std::vector<std::string> warnings;

    [[nodiscard]] std::int64_t count(reuse::Verdict verdict) const;
};

// What a sector's file depends on, as far as is known before it is baked.
[[nodiscard]] Digest task_key(const Digest& content,
                              const bake::Settings& settings,
                              map::SectorCoordinate sector);

// What the database knows for certain; the rest has candidates, or none.
[[nodiscard]] Result<Plan> look_up(Database& database,
                                   const BlobStore& blobs,
                                   const InspectAnswer& map,
                                   const bake::Settings& settings,
                                   const std::vector<map::SectorCoordinate>& sectors);

// The question about the candidates; nothing when there are none.
[[nodiscard]] std::optional<AssessRequest> question_of(const Plan& plan,
                                                       const Digest& manifest,
                                                       const bake::Settings& settings);

// Takes in the answer to question_of(plan), and puts sectors near changes first.
void apply(const AssessAnswer& answer, Plan& plan);

// Reads the files of what is reused. One that is not as it was written is removed and told: its sector is
// baked.
void drop_damaged(BlobStore& blobs, Plan& plan);

}  // namespace drtv::farm
