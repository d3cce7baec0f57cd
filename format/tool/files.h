// Files for the tool: reading one whole, finding the sector files of a folder.
#pragma once

#include <drtv/sector.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drtv::tool {

using FileBytes = std::vector<std::uint8_t>;
using FilePaths = std::vector<std::string>;

// The file's bytes, or nothing with a sentence in `error`. Of a file that does not begin as a sector file
// does, only the beginning.
[[nodiscard]] std::optional<FileBytes> read_file(const std::string& path, std::string& error);

// Writes the file whole or not at all (temporary file, then rename), through links. False with a sentence in
// `error`: also for what is there and no regular file.
[[nodiscard]] bool write_file(const std::string& path, const FileBytes& bytes, std::string& error);

// "1.0" from the header of a sector file. REQUIRES: the file was read without error.
[[nodiscard]] std::string format_version(std::span<const std::uint8_t> bytes);

// `path` itself when it is a file; all regular files `*.drtv` below it, sorted, when it is a folder. Nothing
// where there is none: then the reason is told.
[[nodiscard]] std::optional<FilePaths> sector_files(const std::string& path);

// The sector in a file. Nothing where it cannot be read: then the reason is told and `exit_code` is set.
// `bytes`, where given, gets the file.
[[nodiscard]] std::optional<Sector> load_sector(const std::string& path,
                                                int& exit_code,
                                                FileBytes* bytes = nullptr);

}  // namespace drtv::tool
