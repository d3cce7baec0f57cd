// bake watch: a job's progress until it ends.
#pragma once

#include "client/connection.h"

#include <functional>
#include <string>

namespace drtv::client {

using OnProgress = std::function<void(const v1::Job&)>;

// `job` is "12" or "jobs/12"; `progressed` is told of it now and again. Gives the exit status:
// exit_interrupted when ctrl-C ended the watch, not the job.
int run_watch(Connection& connection, const std::string& job, const OnProgress& progressed = {});

}  // namespace drtv::client
