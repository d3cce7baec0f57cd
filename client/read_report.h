// A job's report from the server.
#pragma once

#include "client/connection.h"
#include "client/job_report.h"

namespace drtv::client {

// Of the sectors and the map of the job. A server that is away for a moment is waited for.
[[nodiscard]] cli::Result<JobReport> read_report(const ServerConnection& connection, const v1::Job& job);

}  // namespace drtv::client
