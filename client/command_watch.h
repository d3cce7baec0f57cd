// bake watch: a job's progress until it ends.
#pragma once

#include "client/connection.h"

#include <functional>
#include <string>

namespace drtv::client {

using OnProgress = std::function<void(const v1::Job&)>;

// `job` is "12" or "jobs/12"; `progressed` is told of it now and again. Ends as the job does, but with
// exit_interrupted when ctrl-C ended the watch, and exit_timeout when the job has not ended after `timeout_s`
// seconds (0: without a limit): then the job goes on.
[[nodiscard]] cli::Result<cli::ExitCode> run_watch(ServerConnection& connection,
                                                   const std::string& job,
                                                   double timeout_s,
                                                   const OnProgress& progressed = {});

}  // namespace drtv::client
