// bake list, status, cancel, retry, raise, hold and release: jobs as they are now.
#pragma once

#include "client/connection.h"

#include <string>

namespace drtv::client {

// Each prints what it is told and gives the exit status. `job` is "12" or "jobs/12".
cli::Result<cli::ExitCode> run_list(ServerConnection& connection, bool mine);
cli::Result<cli::ExitCode> run_status(ServerConnection& connection, const std::string& job);
cli::Result<cli::ExitCode> run_retry(ServerConnection& connection, const std::string& job);
cli::Result<cli::ExitCode> run_raise(ServerConnection& connection, const std::string& job);
cli::Result<cli::ExitCode> run_hold(ServerConnection& connection, const std::string& job);
cli::Result<cli::ExitCode> run_release(ServerConnection& connection, const std::string& job);
cli::Result<cli::ExitCode> run_cancel(ServerConnection& connection, const std::string& job);

}  // namespace drtv::client
