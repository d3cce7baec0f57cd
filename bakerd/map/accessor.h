// Reading accessors: every component type, normalised or not, strided, sparse, with every byte range checked.
#pragma once

#include "bakerd/map/gltf_document.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map {

using Floats = std::vector<float>;
using Indices = std::vector<std::uint32_t>;

// Elements of `components` floats each, in a row. Integers are converted as KHR_mesh_quantization and the
// normalisation rule say. Fails when the accessor has another number of components or holds NaN or infinity.
[[nodiscard]] tl::expected<Floats, std::string> read_floats(const GltfDocument& document,
                                                            int accessor,
                                                            std::size_t components);

// Number of components of the accessor's type (VEC3: 3), or 0 for an unknown type.
[[nodiscard]] std::size_t component_count(const GltfDocument& document, int accessor);

// Scalar unsigned integers of 8, 16 or 32 bits.
[[nodiscard]] tl::expected<Indices, std::string> read_indices(const GltfDocument& document, int accessor);

}  // namespace drtv::map
