// Brings a map to the server.
#pragma once

#include "client/connection.h"
#include "client/map_contents.h"
#include "format/cli/failure.h"

#include <string>

namespace drtv::client {

// Uploads what the server lacks of a map and creates it; gives it as the server does, with its resource name.
// Shows progress. A broken line is tried again for a while, and ctrl-C ends the upload (interrupt.h).
[[nodiscard]] cli::Result<v1::Map> upload_map(ServerConnection& connection, const MapContents& map);

}  // namespace drtv::client
