// The nodes of a glTF document: objects, probes, volumes and lights, where they stand in the world.
#pragma once

#include "bakerd/map/import_state.h"
#include "bakerd/map/material_import.h"

namespace drtv::map {

// The default scene's nodes; of a file without scenes, all. Imports each mesh that one of them shows.
[[nodiscard]] Imported import_nodes(const ImportState& state, const MaterialIndices& materials);

}  // namespace drtv::map
