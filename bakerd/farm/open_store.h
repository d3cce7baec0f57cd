// The store that a daemon works with.
#pragma once

#include "bakerd/farm/data_folder.h"
#include "bakerd/store/blob_store.h"
#include "bakerd/store/error.h"

#include <memory>
#include <string>

namespace drtv::farm {

// A store serves one daemon: what another one evicts would be missed. `store_folder` is claimed for
// the data folder; empty: the blobs lie within that.
[[nodiscard]] store::Result<std::unique_ptr<store::BlobStore>> open_store(const std::string& store_folder,
                                                                          const std::string& blob_folder,
                                                                          const DataFolder& folder);

}  // namespace drtv::farm
