// Which nodes of a document stand in its scene, and which of them are seen.
#pragma once

#include <tiny_gltf.h>

#include <vector>

namespace drtv::map {

// The default scene's roots; of a file without scenes, all nodes that are nobody's child.
[[nodiscard]] std::vector<int> root_nodes(const tinygltf::Model& model);

// Coarser levels of detail of others (MSFT_lod), by node: they stand in the place of those, never beside
// them.
[[nodiscard]] std::vector<bool> coarser_levels(const tinygltf::Model& model);

// Whether the node says that it and its children are not to be seen (KHR_node_visibility).
[[nodiscard]] bool is_hidden(const tinygltf::Node& node);

}  // namespace drtv::map
