// bake cache: the results that bakerd keeps.
#pragma once

#include "client/connection.h"

namespace drtv::client {

// Tells size and hit rate; with `clear`, removes first all that no running job needs. Gives the exit status.
cli::Result<cli::ExitCode> run_cache(ServerConnection& connection, bool clear);

}  // namespace drtv::client
