// Warns of surfaces that send back more light than real ones do.
#pragma once

#include "bakerd/map/import_state.h"

namespace drtv::map {

// A surface that sends back more than max_albedo is more likely a mistake than snow, and light in a room of
// it would hardly ever end. Adds a warning for each material of the document once; `gltf_material` is its
// number there, -1 for the default one, of which nobody is warned. REQUIRES: the primitive is complete.
void warn_of_brightness(const ImportState& state, int gltf_material, const Primitive& primitive);

}  // namespace drtv::map
