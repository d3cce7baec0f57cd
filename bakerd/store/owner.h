// A store that several machines see is one daemon's: what another one evicts would be missed.
#pragma once

#include "bakerd/store/error.h"

#include <string>

namespace drtv::store {

// Makes the folder when it is missing, and writes `owner` into its file "owner". Fails when another one
// stands there.
[[nodiscard]] Result<void> claim_folder(const std::string& folder, const std::string& owner);

}  // namespace drtv::store
