// Where the bytes of a map's files come from: a folder, a store of blobs, or memory.
#pragma once

#include "map_files/limits.h"
#include "map_files/local_map.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map {

using FileBytes = std::vector<std::uint8_t>;

// Larger files are refused.
inline constexpr std::size_t max_file_bytes = map_files::max_file_bytes;

// Why a file cannot be had.
struct FileFailure {
    std::string sentence;
    bool is_missing = false;  // the map has no such file
};

// Gives the bytes of the file with this path, relative to the map's folder, `/` between names. Must be safe
// to call again with the same path, and from several threads.
using FileSource = std::function<tl::expected<FileBytes, FileFailure>(const std::string& path)>;

// Reads from the folder. Symbolic links are followed; a path is never looked up outside by "..", because the
// importer refuses such paths before.
[[nodiscard]] FileSource folder_source(std::string folder);

// Reads the map's files where they lie.
[[nodiscard]] FileSource local_source(map_files::LocalMap map);

}  // namespace drtv::map
