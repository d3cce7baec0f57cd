// bake plan: what would be baked, and why.
#pragma once

#include "client/connection.h"
#include "client/job_request.h"

#include <string>

namespace drtv::client {

// Prints the plan; unless `picture` is empty, a PNG is written there too. Gives the exit status.
cli::Result<cli::ExitCode> run_plan(ServerConnection& connection,
                                    const SubmitOptions& options,
                                    const std::string& picture);

}  // namespace drtv::client
