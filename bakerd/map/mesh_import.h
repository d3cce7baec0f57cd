// Meshes of a glTF document.
#pragma once

#include "bakerd/map/import_state.h"
#include "bakerd/map/material_import.h"

#include <cstddef>
#include <cstdint>
#include <string>

#include <tl/expected.hpp>

namespace drtv::map {

// Whether all primitives together can be read in sensible time and memory.
[[nodiscard]] Imported check_mesh_sizes(const GltfDocument& document);

inline constexpr std::uint32_t no_mesh = UINT32_MAX;

// One glTF mesh; an index into Map::meshes, or no_mesh when it has no triangles. REQUIRES: the document's
// sizes are checked.
[[nodiscard]] tl::expected<std::uint32_t, std::string> import_mesh(const ImportState& state,
                                                                   std::size_t mesh,
                                                                   const MaterialIndices& materials);

}  // namespace drtv::map
