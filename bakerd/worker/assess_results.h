// What the worker makes of older results: reads their records from the store, and asks reuse.
#pragma once

#include "bakerd/reuse/rebake.h"
#include "bakerd/store/blob_store.h"
#include "bakerd/worker/loaded_maps.h"
#include "bakerd/worker/requests.h"

#include <string>

#include <tl/expected.hpp>

namespace drtv::worker {

// `map` is the request's. Of each sector the first candidate that hits is taken, else the near hit with the
// least bound, else that with the fewest probes to bake again. Records that are lost or damaged count for
// nothing, and are reported. Runs on the calling thread's TBB arena.
[[nodiscard]] Assessments assess_results(const AssessRequest& request,
                                         const LoadedMap& map,
                                         store::BlobStore& store);

// An earlier result of the sector, held against the map at hand; a sentence when it or its records are lost
// or damaged. REQUIRES: a FloatMode on this thread.
[[nodiscard]] tl::expected<reuse::EarlierBake, std::string> read_earlier(
    const ResultBlobs& earlier,
    map::SectorCoordinate sector,
    const settings::JobSettings& settings,
    const LoadedMap& map,
    store::BlobStore& store);

}  // namespace drtv::worker
