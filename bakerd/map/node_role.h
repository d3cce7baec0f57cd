// What a node of a glTF document is for, as its extras say.
#pragma once

#include <tiny_gltf.h>

#include <string>

#include <tl/expected.hpp>

namespace drtv::map {

enum class NodeRole { fixed, vegetation, ignore, probe, no_probes, interior };

// Children inherit both.
struct NodePurpose {
    NodeRole role = NodeRole::fixed;
    std::string bake_probe;  // name of the probe that an interior uses, or empty
};

// Replaces what the node's `bake_role` and `bake_probe` say. Fails when one of them is not a string or names
// no role; the sentence does not name the node.
[[nodiscard]] tl::expected<void, std::string> read_purpose(const tinygltf::Node& node, NodePurpose& purpose);

[[nodiscard]] constexpr bool is_volume(NodeRole role) {
    return role == NodeRole::no_probes || role == NodeRole::interior;
}

}  // namespace drtv::map
