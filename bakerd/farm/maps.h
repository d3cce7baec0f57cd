// The maps that the farm knows: manifests of files in the store, and what is in them. Thread-safe.
#pragma once

#include "bakerd/executor/executor.h"
#include "bakerd/farm/records.h"
#include "bakerd/store/blob_store.h"
#include "bakerd/store/error.h"
#include "bakerd/store/manifest.h"

namespace drtv::farm {

class Database;

class Maps {
  public:
    // REQUIRES: all outlive it.
    Maps(Database& database, store::BlobStore& blobs, executor::Executor& executor)
        : database_(database), blobs_(blobs), executor_(executor) {}

    // Has the worker import the map, unless it is known.
    [[nodiscard]] store::Result<MapView> create(store::Manifest manifest);
    [[nodiscard]] store::Result<MapView> get(const Digest& id);
    [[nodiscard]] store::Result<worker::MapSummary> summary_of(const Digest& manifest);

  private:
    [[nodiscard]] store::Result<worker::MapSummary> known_or_inspected(const Digest& id);

    Database& database_;
    store::BlobStore& blobs_;
    executor::Executor& executor_;
};

}  // namespace drtv::farm
