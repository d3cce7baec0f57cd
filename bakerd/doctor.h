// The command `bakerd doctor`: what a node of a cluster lacks to bake for a daemon.
#pragma once

#include "format/cli/failure.h"

#include <string>

namespace drtv {

struct DoctorOptions {
    std::string store;
    std::string partition;  // whose nodes are looked at; empty: all
};

// Prints a line for each thing it looks at. exit_invalid where one of them keeps tasks from baking.
[[nodiscard]] cli::Result<cli::ExitCode> examine_node(const DoctorOptions& options);

}  // namespace drtv
