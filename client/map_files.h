// Which files a map is made of: the glTF files named on the command line and what they refer to.
#pragma once

#include "format/cli/failure.h"

#include <cstdint>
#include <string>
#include <vector>

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
[[nodiscard]] cli::Result<LocalMap> collect_map(const std::vector<std::string>& arguments);

}  // namespace drtv::client
