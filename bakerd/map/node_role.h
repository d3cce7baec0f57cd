// What a node of a glTF document is for, as its extras say.
#pragma once

#include <tiny_gltf.h>

#include <string>

#include <tl/expected.hpp>

namespace drtv::map {

enum class NodeRole {
    fixed,
    vegetation,
    ignore,
    probe,
    no_probes,
    interior,
    spacing,  // of a node that says bake_spacing and no role
};

// Children inherit it.
struct NodePurpose {
    NodeRole role = NodeRole::fixed;
    std::string bake_probe;   // name of the probe that an interior uses, or empty
    float spacing_m = 0;      // between automatic probes inside of the mesh; 0 where nothing is said
    std::string light_group;  // of what shines; empty where nothing is said
};

// Replaces what the node's `bake_role`, `bake_probe`, `bake_spacing` and `light_group` say; a role of its own
// ends what is inherited of the spacing. Fails when one of them is of another type, names no role, is out of
// range or does not go with the others; the sentence does not name the node.
[[nodiscard]] tl::expected<void, std::string> read_purpose(const tinygltf::Node& node, NodePurpose& purpose);

// Whether it says `bake_role` itself.
[[nodiscard]] bool has_role(const tinygltf::Node& node);

// Whether it says `light_group` itself.
[[nodiscard]] bool has_light_group(const tinygltf::Node& node);

[[nodiscard]] constexpr bool is_volume(NodeRole role) {
    return role == NodeRole::no_probes || role == NodeRole::interior || role == NodeRole::spacing;
}

// Ends of sentences about a node. So many meshes below it inherit its role of a probe.
[[nodiscard]] std::string inherited_probe(std::size_t meshes);
// A mesh that glows, with a spacing alone.
inline constexpr const char* dark_volume =
    "bake_spacing without a bake_role makes it a volume, which does not glow: add bake_role 'static' where "
    "it "
    "should";

}  // namespace drtv::map
