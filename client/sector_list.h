// The sectors of a job, as the server knows them.
#pragma once

#include "client/connection.h"

#include <functional>
#include <string>

namespace drtv::client {

// Visits them in the order of (j, i); `job` is its resource's name.
[[nodiscard]] cli::Result<void> for_each_sector(const ServerConnection& connection,
                                                const std::string& job,
                                                const std::function<void(const v1::Sector&)>& visit);

}  // namespace drtv::client
