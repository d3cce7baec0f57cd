// Materials of a glTF document, with their textures.
#pragma once

#include "bakerd/map/import_state.h"

#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map {

// Index into Map::materials of each glTF material of one document that some primitive wears (UINT32_MAX of
// the others); the last one is glTF's default material.
using MaterialIndices = std::vector<std::uint32_t>;

// "material 3 ('wall')".
[[nodiscard]] std::string name_of_material(const GltfDocument& document, std::size_t material);

// A picture missing from a material that no primitive wears is no harm.
[[nodiscard]] tl::expected<MaterialIndices, std::string> import_materials(const ImportState& state);

}  // namespace drtv::map
