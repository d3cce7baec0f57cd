// Sector files of a job, out of the server's stream into a folder.
#pragma once

#include "client/connection.h"
#include "format/cli/failure.h"

#include <cstdint>
#include <functional>
#include <string>

namespace drtv::client {

// Writes the files of the wanted sectors, each whole, and tells `written` of each. Files that were written
// before the stream broke stay. Fails with exit_interrupted after ctrl-C. REQUIRES: the folder is there.
[[nodiscard]] cli::Result<void> stream_sectors(ServerConnection& connection,
                                               const v1::PullSectorsRequest& wanted,
                                               const std::string& folder,
                                               const std::function<void(const v1::Sector&)>& written);

}  // namespace drtv::client
