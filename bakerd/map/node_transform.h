// Where a node and its instances stand, in the frame of its parent (of the node). Sentences name neither file
// nor node; the caller does.
#pragma once

#include "bakerd/map/gltf_document.h"

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map {

// parent_from_node, affine.
[[nodiscard]] tl::expected<glm::dmat4, std::string> local_transform(const tinygltf::Node& node);

// node_from_instance of EXT_mesh_gpu_instancing, whose types the document's check saw to.
[[nodiscard]] tl::expected<std::vector<glm::dmat4>, std::string> instance_transforms(
    const GltfDocument& document, const tinygltf::Value& extension);

}  // namespace drtv::map
