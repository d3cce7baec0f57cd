// Files that appear whole or not at all, and stay: temporary file, fsync, rename, fsync of the folders.
#pragma once

#include "bakerd/store/error.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::store {

// A failure by errno: "cannot <what> <path>: why".
[[nodiscard]] tl::unexpected<Error> file_error(const std::string& what, const std::string& path);

// With those above it, where they are missing.
[[nodiscard]] Result<void> make_folder(const std::string& path);

// False and errno where not all bytes could be written.
[[nodiscard]] bool write_all(int fd, std::span<const std::uint8_t> bytes);

// A file that is cut short meanwhile gives what is there.
[[nodiscard]] Result<std::vector<std::uint8_t>> read_all(const std::string& path);

// The temporary file is written in a folder of the same file system. Makes the file's own folder when it is
// missing.
[[nodiscard]] Result<void> write_durably(const std::string& temporary_folder,
                                         const std::string& path,
                                         std::span<const std::uint8_t> bytes);

// The second half of the above, of a file that has been synced.
[[nodiscard]] Result<void> rename_durably(const std::string& temporary, const std::string& path);

}  // namespace drtv::store
