#pragma once

#include <string>

namespace drtv::store {

// "unknown" where the system does not say.
[[nodiscard]] std::string host_name();

}  // namespace drtv::store
