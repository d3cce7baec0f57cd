// What differs between a map and those before it.
#pragma once

#include "bakerd/reuse/inventory.h"
#include "bakerd/store/blob_store.h"
#include "bakerd/worker/requests.h"

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::worker {

// Each earlier map is compared once. Thread-safe.
class ChangesSince {
  public:
    using Changes = std::shared_ptr<const std::vector<reuse::Change>>;

    // Of the map with that inventory. REQUIRES: the store outlives it.
    ChangesSince(std::shared_ptr<const reuse::Inventory> inventory, store::BlobStore& store);

    // Since the map with the inventory that the store has under that digest; a sentence when it cannot be
    // read.
    [[nodiscard]] tl::expected<Changes, std::string> map(const Digest& inventory);

  private:
    const std::shared_ptr<const reuse::Inventory> inventory_;
    store::BlobStore& store_;
    std::mutex mutex_;
    std::map<Digest, Changes> known_;  // guarded by mutex_
};

}  // namespace drtv::worker
