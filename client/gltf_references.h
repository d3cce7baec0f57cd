// The files that a glTF document names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drtv::client {

// The uris of the buffers and images that lie outside a .gltf or .glb. What is no glTF names none: the
// server's importer knows what is wrong, and says so.
[[nodiscard]] std::vector<std::string> outside_uris(const std::filesystem::path& document);

}  // namespace drtv::client
