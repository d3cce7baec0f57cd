// What the worker makes of older results: reads their records from the store, and asks bake.
#pragma once

#include "bakerd/bake/world.h"
#include "bakerd/farm/blob_store.h"
#include "bakerd/farm/worker_protocol.h"
#include "bakerd/reuse/inventory.h"
#include "bakerd/reuse/rebake.h"

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace drtv::farm {

// What differs between a map and those before it, each compared once. Thread-safe.
class ChangesSince {
  public:
    ChangesSince(std::shared_ptr<const reuse::Inventory> inventory, BlobStore& store)
        : inventory_(std::move(inventory)), store_(store) {}

    // Since the map with that inventory; nothing when it cannot be read, with a sentence in `problem`.
    [[nodiscard]] std::shared_ptr<const std::vector<reuse::Change>> map(const Digest& inventory,
                                                                        std::string& problem);

  private:
    const std::shared_ptr<const reuse::Inventory> inventory_;
    BlobStore& store_;
    std::mutex mutex_;
    std::map<Digest, std::shared_ptr<const std::vector<reuse::Change>>> known_;  // guarded by mutex_
};

// `world` and `changes` are of the request's map. Of each sector the first candidate that hits is taken, else
// the near hit with the least bound, else that with the fewest probes to bake again. Records that are lost or
// damaged count for nothing, and are told of. Runs on the calling thread's TBB arena.
[[nodiscard]] AssessAnswer assess_results(const AssessRequest& request,
                                          bake::World& world,
                                          ChangesSince& changes,
                                          BlobStore& store);

// The earlier result that a request names, held against `world`; nothing when it or its records are lost or
// damaged. REQUIRES: a FloatMode on this thread.
[[nodiscard]] std::optional<reuse::EarlierBake> read_earlier(const BakeRequest& request,
                                                             bake::World& world,
                                                             ChangesSince& changes,
                                                             BlobStore& store);

}  // namespace drtv::farm
