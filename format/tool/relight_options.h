// The command line of what relights.
#pragma once

#include "command_relight.h"

#include <CLI/CLI.hpp>

#include <functional>

namespace drtv::tool {

// The light of a moment: by the time of day, or by numbers. The same for every command that relights.
void add_light(CLI::App& command, LightRequest& light);

// Sets `run` when the command is on the line.
void add_relight(CLI::App& app, RelightRequest& request, std::function<int()>& run);

}  // namespace drtv::tool
