// The files that a map is made of, as they are uploaded: the documents named on the command line and what
// they refer to.
#pragma once

#include "format/cli/failure.h"

#include <cstdint>
#include <string>
#include <vector>

namespace drtv::client {

struct MapContentFile {
    std::string disk_path;  // to open
    std::string map_path;   // relative to the map's folder
    std::string sha256;
    std::int64_t size_bytes = 0;
};

struct MapContents {
    std::vector<MapContentFile> files;
    std::vector<std::string> roots;     // map paths
    std::vector<std::string> repeated;  // documents that were named more than once
};

// `arguments` are .gltf or .glb files, or folders of them. A file that a document names but that is not there
// is left out: the server's importer knows whether it matters, and says so.
[[nodiscard]] cli::Result<MapContents> collect_map(const std::vector<std::string>& arguments);

}  // namespace drtv::client
