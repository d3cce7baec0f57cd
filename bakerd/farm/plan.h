// Decides for each sector of a job whether a stored result can be reused, and why not: the cache knows some
// that hold (look_up), the worker looks at the rest (make_assess_request, merge_answer), and files may be
// damaged (drop_damaged).
#pragma once

#include "bakerd/farm/records.h"
#include "bakerd/reuse/verdict.h"
#include "bakerd/store/blob_store.h"
#include "bakerd/store/error.h"
#include "bakerd/worker/requests.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drtv::farm {

class CachePin;
class ResultCache;
struct CacheQuery;

struct PlannedSector {
    map::SectorCoordinate sector;
    reuse::Verdict verdict = reuse::Verdict::rebake;
    std::optional<ResultRow> reused;    // unless rebake
    float bound = 0;                    // of a near hit
    std::string reason;                 // one sentence; empty of a hit
    std::string cause;                  // that part of it which other sectors share; likewise
    std::optional<ResultRow> earlier;   // of another map, of which a rebake reuses what holds
    float share = 1;                    // of its probes, that a rebake has to bake
    double seconds = 0;                 // that baking it will take, as far as is known; 0: not
    float ring = 0;                     // around the nearest change: the nearest are baked first
    std::vector<ResultRow> candidates;  // to be assessed, the one used last first
};

struct Plan {
    std::vector<PlannedSector> sectors;  // in the order of baking
    std::vector<worker::MapChange> changes;
    std::vector<std::string> warnings;

    [[nodiscard]] std::int64_t count(reuse::Verdict verdict) const;
};

// What the cache knows for certain; the rest has candidates, or none.
[[nodiscard]] store::Result<Plan> look_up(ResultCache& cache,
                                          std::span<const map::SectorCoordinate> sectors,
                                          const CacheQuery& query,
                                          CachePin& pin);

// The question about the candidates; nothing when there are none.
[[nodiscard]] std::optional<worker::AssessRequest> make_assess_request(const Plan& plan,
                                                                       const Digest& manifest,
                                                                       const settings::JobSettings& settings);

// Takes in the answer to make_assess_request(plan), and puts sectors near changes first.
void merge_answer(const worker::Assessments& answer, Plan& plan);

// Reads the files of what is reused. One that is not as it was written is removed and reported: its sector is
// baked.
void drop_damaged(store::BlobStore& blobs, Plan& plan);

}  // namespace drtv::farm
