// The worker's answer to which older results still hold: reads their records from the store, and asks bake.
#pragma once

#include "bakerd/bake/inventory.h"
#include "bakerd/bake/world.h"
#include "bakerd/farm/blob_store.h"
#include "bakerd/farm/worker_protocol.h"

namespace drtv::farm {

// `world` and `inventory` are of the request's map. Of each sector the first candidate that hits is taken, else the near hit with the least bound. Records
// that are lost or damaged count for nothing, and are told of. Runs on the calling thread's TBB arena.
[[nodiscard]] AssessAnswer assess_results(const AssessRequest& request, bake::World& world, const bake::Inventory& inventory, BlobStore& store);

}  // namespace drtv::farm
