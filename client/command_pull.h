// bake pull: a job's finished sector files, in a folder.
#pragma once

#include "client/connection.h"

#include <string>

namespace drtv::client {

// Makes the folder when it is missing. Gives the exit status.
cli::Result<cli::ExitCode> run_pull(ServerConnection& connection,
                                    const std::string& job,
                                    const std::string& folder,
                                    bool replace);

}  // namespace drtv::client
