// bake watch and wait: a job until it ends.
#pragma once

#include "client/connection.h"

#include <functional>
#include <string>

namespace drtv::client {

using OnProgress = std::function<void(const v1::Job&)>;

struct WatchOptions {
    bool quiet = false;  // its end alone is told
    OnProgress progressed = {};
};

// The job as it ended; `job` is "12" or "jobs/12". Fails with exit_interrupted when ctrl-C ended the watch,
// and with exit_timeout when the time was over (limit_time): then the job goes on.
[[nodiscard]] cli::Result<v1::Job> watch_job(ServerConnection& connection,
                                             const std::string& job,
                                             const WatchOptions& options);

// Says how a job ended, after its warnings: all of them under --json, else the first, and how many more there
// are. Gives the exit status (end_of).
[[nodiscard]] cli::Result<cli::ExitCode> tell_end(const ServerConnection& connection, const v1::Job& job);

[[nodiscard]] cli::Result<cli::ExitCode> run_watch(ServerConnection& connection,
                                                   const std::string& job,
                                                   const WatchOptions& options);

}  // namespace drtv::client
