// Files for the tool: reading one whole, finding the sector files of a folder.
#pragma once

#include "cli/failure.h"

#include <drtv/sector.h>
#include <drtv/view.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace drtv::kit {

using FileBytes = std::vector<std::uint8_t>;
using FilePaths = std::vector<std::string>;

// All bytes of the file. Of one that does not begin as a sector file does, only the beginning.
[[nodiscard]] cli::Result<FileBytes> read_file(const std::string& path);

[[nodiscard]] cli::Result<std::string> read_standard_input();

// The sector (i, j) that a file's header names, where it begins as a sector file does; nothing where it
// cannot be read.
[[nodiscard]] std::optional<std::pair<std::int32_t, std::int32_t>> sector_of_file(const std::string& path);

// Writes the file whole or not at all (temporary file, then rename), through links. Fails, too, for what is
// there and no regular file.
[[nodiscard]] cli::Result<void> write_file(const std::string& path, const FileBytes& bytes);

// "1.0" from the header of a sector file. REQUIRES: the file was read without error.
[[nodiscard]] std::string format_version(std::span<const std::uint8_t> bytes);

// `path` itself when it is a file; all regular files `*.drtv` below it, sorted, when it is a folder. Fails
// where there is none.
[[nodiscard]] cli::Result<FilePaths> sector_files(const std::string& path);

// A sector as a game has it: raw bytes, and the view of them.
struct RawSector {
    FileBytes bytes;
    SectorView view;  // of the bytes; stays right when this is moved
};
[[nodiscard]] cli::Result<RawSector> load_raw_sector(const std::string& path);

// The sector in a file. `bytes`, where given, gets the file.
[[nodiscard]] cli::Result<Sector> load_sector(const std::string& path, FileBytes* bytes = nullptr);

}  // namespace drtv::kit
