// Writes files and folders that other programs look at, also while they are written.
#pragma once

#include "cli/failure.h"

#include <string>
#include <string_view>

namespace drtv::folder {

// Writes a file: it appears whole or not at all (temporary file, then rename), whoever else writes it at the
// same time. The file behind a link is replaced, not the link. Fails, too, for what is there and no regular
// file. The sentence names the file.
[[nodiscard]] cli::Result<void> write_whole(const std::string& path, std::string_view bytes);

// The same without a look at what is there: a link is replaced itself. Faster, for many files.
[[nodiscard]] cli::Result<void> put_whole(const std::string& path, std::string_view bytes);

// All bytes of a file. The sentence names it.
[[nodiscard]] cli::Result<std::string> read_whole(const std::string& path);

// Makes the folder and those above it, and tries whether files can be written there; a sentence where not.
[[nodiscard]] cli::Result<void> make_folder(const std::string& folder);

// Removes what writes of sector files left there that a kill or a power cut broke off.
void remove_leftovers(const std::string& folder);

// Brings all that was written to the folder's file system to the disk.
[[nodiscard]] cli::Result<void> sync_folder(const std::string& folder);

}  // namespace drtv::folder
