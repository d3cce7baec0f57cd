// glTF 2.0 files -> Map. Any input gives a map or one sentence; nothing is half-imported.
#pragma once

#include "bakerd/map/file_source.h"
#include "bakerd/map/map.h"

#include <span>
#include <string>

#include <tl/expected.hpp>

namespace drtv::map {

// Imports the .gltf and .glb files `paths` into one map. Each file's buffers and images are looked up beside
// it, and so is a roles.json. The sentence names the file and the element: "island.glb: mesh 3, primitive 0:
// index 17 is past the 8 vertices".
[[nodiscard]] tl::expected<Map, std::string> import_map(std::span<const std::string> paths,
                                                        const FileSource& files);

}  // namespace drtv::map
