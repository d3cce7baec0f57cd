// Punctual lights of a glTF document.
#pragma once

#include "bakerd/map/map.h"

#include <tiny_gltf.h>

#include <string>

#include <tl/expected.hpp>

namespace drtv::map {

// One light but for its place and name. The sentence names the light. REQUIRES: the light exists.
[[nodiscard]] tl::expected<Light, std::string> import_light(const tinygltf::Model& model, int number);

// A sentence about what is hardly meant; else empty.
[[nodiscard]] std::string doubt_about(const Light& light);

}  // namespace drtv::map
