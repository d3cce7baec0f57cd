// Writes files and folders that other programs look at.
#pragma once

#include "format/cli/failure.h"

#include <string>

namespace drtv::client {

using Done = cli::Result<void>;

// Writes a file: it appears whole or not at all. The sentence names the file.
[[nodiscard]] Done write_whole(const std::string& path, const std::string& bytes);

// Makes the folder and those above it; a sentence when it cannot be had.
[[nodiscard]] Done make_folder(const std::string& folder);

}  // namespace drtv::client
