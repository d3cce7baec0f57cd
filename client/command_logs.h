// bake logs: what a cluster's task printed of a sector.
#pragma once

#include "client/connection.h"

#include <string>

namespace drtv::client {

// `job` is "12" or "jobs/12", `sector` "I,J".
cli::Result<cli::ExitCode> run_logs(ServerConnection& connection,
                                    const std::string& job,
                                    const std::string& sector);

}  // namespace drtv::client
