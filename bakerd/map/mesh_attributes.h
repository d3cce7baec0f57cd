// The vertices of a glTF primitive, as its material needs them.
#pragma once

#include "bakerd/map/accessor.h"
#include "bakerd/map/gltf_document.h"
#include "bakerd/map/map.h"

#include <cstddef>
#include <string>

#include <tl/expected.hpp>

namespace drtv::map {

// One after the other: positions have 3 numbers per vertex, uvs 2, colours 3 or 4.
struct Attributes {
    std::size_t vertex_count = 0;
    Floats positions;
    Floats uvs;               // empty unless the material has a base texture
    Floats emission_uvs;      // empty unless the material has an emission texture
    Floats transmission_uvs;  // empty unless the material has a transmission texture
    Floats colours;           // empty unless the primitive has COLOR_0
    std::size_t colour_components = 0;
};

// A primitive and what sentences call it.
struct NamedPrimitive {
    const tinygltf::Primitive& gltf;
    std::string where;  // "mesh 3, primitive 0"
};

// `material` is the imported one that the primitive wears. Without vertices, nothing but positions is read.
// REQUIRES: the primitive has positions.
[[nodiscard]] tl::expected<Attributes, std::string> read_attributes(const GltfDocument& document,
                                                                    const NamedPrimitive& primitive,
                                                                    const Material& material);

}  // namespace drtv::map
