// bake report: a job in numbers.
#pragma once

#include "client/connection.h"

#include <string>

namespace drtv::client {

[[nodiscard]] cli::Result<cli::ExitCode> run_report(ServerConnection& connection, const std::string& job);

}  // namespace drtv::client
