// A question before a job that may be a mistake.
#pragma once

#include "client/connection.h"
#include "client/job_request.h"

namespace drtv::client {

// Asks on a terminal before more sectors are baked than people mean by mistake; without a terminal it fails.
// With `yes` it asks nothing.
[[nodiscard]] cli::Result<void> confirm_size(ServerConnection& connection,
                                             const PreparedJob& prepared,
                                             bool yes);

}  // namespace drtv::client
