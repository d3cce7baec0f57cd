// Meshes of a glTF document.
#pragma once

#include "bakerd/map/import_state.h"
#include "bakerd/map/material_import.h"
#include "bakerd/map/skin.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace drtv::map {

// Whether all primitives together can be read in sensible time and memory.
[[nodiscard]] Imported check_mesh_sizes(const GltfDocument& document);

inline constexpr std::uint32_t no_mesh = UINT32_MAX;

// The meshes of a document, each imported once for each skin that it wears.
class MeshImporter {
  public:
    // REQUIRES: the document's sizes are checked; all outlive it.
    MeshImporter(const ImportState& state, const MaterialIndices& materials)
        : state_(state), materials_(materials), skins_(state.document) {}

    // Of a node's mesh an index into Map::meshes, or no_mesh when it has no triangles. Of a node with a skin,
    // its vertices stand where the joints hold them, in the scene's axes. REQUIRES: the node has a mesh.
    [[nodiscard]] tl::expected<std::uint32_t, std::string> index_of(const tinygltf::Node& node);

  private:
    const ImportState& state_;
    const MaterialIndices& materials_;
    Skins skins_;
    std::map<std::pair<int, int>, std::uint32_t> known_;  // by glTF mesh and skin
    std::size_t posed_elements_ = 0;                      // of accessors
};

}  // namespace drtv::map
