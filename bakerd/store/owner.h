// A store that several machines see is one daemon's: what another one evicts would be missed.
#pragma once

#include "bakerd/store/error.h"

#include <string>

namespace drtv::store {

// One line in a file; empty where there is no file.
[[nodiscard]] Result<std::string> read_mark(const std::string& path);
[[nodiscard]] Result<void> write_mark(const std::string& path, const std::string& text);

// Makes the folder when it is missing, and writes `owner` into its file "owner", with a second line that
// tells people where it is. Fails when another one stands there, or none where the folder `is_known` to be
// the owner's: it is not mounted, then.
[[nodiscard]] Result<void> claim_folder(const std::string& folder,
                                        const std::string& owner,
                                        const std::string& place,
                                        bool is_known);

}  // namespace drtv::store
