// Files for the tool: reading one whole, finding the sector files of a folder.
#pragma once

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

struct FileRead {
    FileBytes bytes;
    std::string error;  // a sentence; empty where the file could be read

    [[nodiscard]] bool ok() const { return error.empty(); }
};

// All bytes of the file. Of one that does not begin as a sector file does, only the beginning.
[[nodiscard]] FileRead read_file(const std::string& path);

struct TextRead {
    std::string text;
    std::string error;  // as above
};
[[nodiscard]] TextRead read_text(const std::string& path);
[[nodiscard]] TextRead read_standard_input();

// The sector (i, j) that a file's header names, where it begins as a sector file does; nothing where it
// cannot be read.
[[nodiscard]] std::optional<std::pair<std::int32_t, std::int32_t>> sector_of_file(const std::string& path);

// Writes the file whole or not at all (temporary file, then rename), through links. Gives a sentence where it
// fails: also for what is there and no regular file.
[[nodiscard]] std::string write_file(const std::string& path, const FileBytes& bytes);

// The same of a picture. What is there and no PNG file is not replaced.
[[nodiscard]] std::string write_png_file(const std::string& path, const FileBytes& png);

// Why a picture could not be written there, before it is made; empty where nothing speaks against it.
[[nodiscard]] std::string png_target_problem(const std::string& path);

// "1.0" from the header of a sector file. REQUIRES: the file was read without error.
[[nodiscard]] std::string format_version(std::span<const std::uint8_t> bytes);

// `path` itself when it is a file; all regular files `*.drtv` below it, sorted, when it is a folder. Nothing
// where there is none: then the reason is told.
[[nodiscard]] std::optional<FilePaths> sector_files(const std::string& path);

// A sector as a game has it: raw bytes, and the view of them.
struct RawSector {
    FileBytes bytes;
    SectorView view;  // of the bytes; stays right when this is moved
};
// As load_sector below.
[[nodiscard]] std::optional<RawSector> load_raw_sector(const std::string& path, int& exit_code);

// The sector in a file. Nothing where it cannot be read: then the reason is told and `exit_code` is set.
// `bytes`, where given, gets the file.
[[nodiscard]] std::optional<Sector> load_sector(const std::string& path,
                                                int& exit_code,
                                                FileBytes* bytes = nullptr);

}  // namespace drtv::kit
