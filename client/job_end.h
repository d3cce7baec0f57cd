// A job as it stands, and what its end means for the program.
#pragma once

#include "client/connection.h"
#include "format/cli/failure.h"

#include <string>

namespace drtv::client {

// `job` is "12" or "jobs/12".
[[nodiscard]] cli::Result<v1::Job> get_job(ServerConnection& connection, const std::string& job);

// The map of a job, with its warnings.
[[nodiscard]] grpc::Status find_map(const ServerConnection& connection, const v1::Job& job, v1::Map& map);

// exit_done of a job that has succeeded; fails with exit_job_failed or exit_unfinished, and with exit_invalid
// where it has no probe: that is nothing to put into a game.
[[nodiscard]] cli::Result<cli::ExitCode> end_of(const v1::Job& job);

}  // namespace drtv::client
