// The maps that a worker keeps warm.
#pragma once

#include "bakerd/bake/recent.h"
#include "bakerd/bake/world.h"
#include "bakerd/reuse/inventory.h"
#include "bakerd/store/blob_store.h"
#include "bakerd/trace/device.h"
#include "bakerd/trace/geometry.h"
#include "bakerd/worker/changes_since.h"
#include "bakerd/worker/requests.h"

#include <memory>

#include <tl/expected.hpp>

namespace drtv::worker {

struct LoadedMap {
    std::shared_ptr<bake::World> world;
    MapSummary summary;
    std::shared_ptr<const reuse::Inventory> inventory;
    std::shared_ptr<ChangesSince> changes;
};

using LoadResult = tl::expected<LoadedMap, RequestFailure>;

// Thread-safe.
class LoadedMaps {
  public:
    // REQUIRES: the store outlives it.
    LoadedMaps(store::BlobStore& store, std::shared_ptr<const trace::Device> device);

    // Imports the map of that manifest once, however many threads ask for it at the same time.
    [[nodiscard]] std::shared_ptr<const LoadResult> get(const Digest& manifest);

  private:
    [[nodiscard]] LoadResult load(const Digest& manifest) const;

    store::BlobStore& store_;
    const std::shared_ptr<const trace::Device> device_;
    const std::shared_ptr<trace::MeshShelf> shelf_;  // an edit leaves most meshes as they were
    bake::Recent<Digest, LoadResult> maps_;
};

}  // namespace drtv::worker
