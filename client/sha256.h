// SHA-256 as the daemon names blobs by it: 64 lower-case hexadecimal digits.
#pragma once

#include "format/cli/failure.h"

#include <string>

namespace drtv::client {

// Of a file that may be written to again: the digest is of what was read. The sentence names the file.
[[nodiscard]] cli::Result<std::string> sha256_of_file(const std::string& path);

[[nodiscard]] std::string sha256_of_text(const std::string& bytes);

}  // namespace drtv::client
