// What the sector files of a folder hold, summed up.
#pragma once

#include "cli/failure.h"

#include <string>

namespace drtv::tool {

// Prints it. Fails where the folder holds no sector file, or one that cannot be read.
[[nodiscard]] cli::Result<cli::ExitCode> print_folder_info(const std::string& folder);

}  // namespace drtv::tool
