// Sector files of a job, out of the server's stream.
#pragma once

#include "client/connection.h"
#include "client/file_writers.h"
#include "format/cli/failure.h"

#include <optional>

namespace drtv::client {

struct LostFiles {
    int count = 0;
    cli::Failure failure;  // of the pull
};

// Gives the files of the wanted sectors to the writers, all but those that the server has lost. Fails with
// exit_interrupted after ctrl-C.
[[nodiscard]] cli::Result<std::optional<LostFiles>> stream_sectors(ServerConnection& connection,
                                                                   const v1::PullSectorsRequest& wanted,
                                                                   FileWriters& writers);

}  // namespace drtv::client
