#pragma once

#include <string>

namespace drtv::client {

// Of who runs this program: the login name, or the number where the system knows none.
[[nodiscard]] std::string user_name();

}  // namespace drtv::client
