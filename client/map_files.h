// Which files a map is made of: the glTF files named on the command line and what they refer to.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::client {

struct LocalFile {
    std::string disk_path;  // to open
    std::string map_path;   // relative to the map's folder
    std::string sha256;
    std::int64_t size_bytes = 0;
};

struct LocalMap {
    std::vector<LocalFile> files;
    std::vector<std::string> roots;  // map paths
};

// `arguments` are .gltf or .glb files, or folders of them. A file that a glTF names but that is not there is
// left out: the server's importer knows whether it matters, and says so.
[[nodiscard]] tl::expected<LocalMap, std::string> collect_map(const std::vector<std::string>& arguments);

// SHA-256 of a file that may be written to again: the digest is of what was read.
[[nodiscard]] tl::expected<std::string, std::string> sha256_of_file(const std::string& path);
[[nodiscard]] std::string sha256_of_text(const std::string& bytes);

// Writes a file: it appears whole or not at all.
[[nodiscard]] tl::expected<void, std::string> write_whole(const std::string& path, const std::string& bytes);

}  // namespace drtv::client
