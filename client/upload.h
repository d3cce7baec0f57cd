// Brings a map to the server.
#pragma once

#include "client/connection.h"
#include "client/map_files.h"

#include <string>

#include <tl/expected.hpp>

namespace drtv::client {

// Uploads what the server lacks of a map and creates it; gives it as the server does, with its resource name.
// Shows progress. A broken line is tried again for a while, and ctrl-C ends the upload (interrupt.h).
[[nodiscard]] tl::expected<v1::Map, std::string> upload_map(Connection& connection, const LocalMap& map);

}  // namespace drtv::client
