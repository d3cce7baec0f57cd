// The command line of `drtv relight`.
#pragma once

#include "command_relight.h"

#include <CLI/CLI.hpp>

#include <functional>

namespace drtv::tool {

// Sets `run` when the command is on the line.
void add_relight(CLI::App& app, RelightRequest& request, std::function<cli::Result<cli::ExitCode>()>& run);

}  // namespace drtv::tool
