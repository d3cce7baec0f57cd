// Things of the map as sentences name them.
#pragma once

#include "bakerd/map/map.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <string>

namespace drtv::bake {

// 'Name', or what stands for one that has none.
[[nodiscard]] std::string shown_name(const std::string& name, const char* kind);

[[nodiscard]] std::string shown_object(const map::Map& map, std::uint32_t object);

// "(1.00, 2.00, 3.00)", metres.
[[nodiscard]] std::string shown_place(const glm::dvec3& place);

}  // namespace drtv::bake
