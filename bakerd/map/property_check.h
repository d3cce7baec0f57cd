// Custom properties that say something to drtv where it does not listen, or nearly so.
#pragma once

#include <tiny_gltf.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drtv::map {

// The property that a key of this spelling most likely means; nothing where the key is one, or means none.
[[nodiscard]] std::optional<std::string_view> property_meant(std::string_view key);

[[nodiscard]] bool is_property(std::string_view key);

// A sentence for each property in the extras of something that is not a node, and for each key of a node that
// is a property but for its spelling. Blender keeps the properties of an object apart from those of its data,
// and the former alone stand in a node.
[[nodiscard]] std::vector<std::string> unheard_properties(const tinygltf::Model& model);

}  // namespace drtv::map
