// The light of a moment on the command line: the same options for every command that relights.
#pragma once

#include "light_request.h"

#include <CLI/CLI.hpp>

namespace drtv::kit {

// By the time of day, or by numbers.
void add_light(CLI::App& command, LightRequest& light);

}  // namespace drtv::kit
