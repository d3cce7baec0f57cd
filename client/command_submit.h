// bake submit: a map becomes a job.
#pragma once

#include "client/connection.h"
#include "client/job_request.h"

namespace drtv::client {

// Submits, and when the options say so, watches the job to its end and pulls its files while they are made.
// Gives the exit status.
cli::Result<cli::ExitCode> run_submit(ServerConnection& connection, const SubmitOptions& options);

}  // namespace drtv::client
