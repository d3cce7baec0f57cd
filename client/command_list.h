// bake list, status and cancel: jobs as they are now.
#pragma once

#include "client/connection.h"

#include <string>

namespace drtv::client {

// Each prints what it is told and gives the exit status. `job` is "12" or "jobs/12".
int run_list(Connection& connection);
int run_status(Connection& connection, const std::string& job);
int run_cancel(Connection& connection, const std::string& job);

}  // namespace drtv::client
