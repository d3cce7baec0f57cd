// The files that a glTF document names.
#pragma once

#include <string>
#include <vector>

namespace drtv::client {

// Those of the buffers and images of a .gltf or .glb, as paths below the document's folder; they need not be
// there. What is no glTF names none: the server's importer knows what is wrong, and says so.
[[nodiscard]] std::vector<std::string> referenced_files(const std::string& gltf_path);

}  // namespace drtv::client
