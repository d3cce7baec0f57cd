// SHA-256 as files are named by it: 64 lower-case hexadecimal digits.
#pragma once

#include "cli/failure.h"

#include <string>
#include <string_view>

namespace drtv::folder {

// Of a file that may be written to again: the digest is of what was read. The sentence names the file.
[[nodiscard]] cli::Result<std::string> sha256_of_file(const std::string& path);

[[nodiscard]] std::string sha256_of_text(std::string_view bytes);

}  // namespace drtv::folder
