// The scene on which the product is held against the reference, and the places of its probes.
#pragma once

#include "bakerd/map/map.h"

#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <string_view>

namespace drtv::reference {

// Ground, walls that meet in a corner, a one-sided wall, a roof, ten trees of masked leaves, mirrored
// instances: all within sector (0, 0).
[[nodiscard]] map::Map make_yard();

struct YardProbe {
    std::string_view where;
    glm::ivec3 position_units;  // of 1/1024 m
};

[[nodiscard]] std::span<const YardProbe> yard_probes();

}  // namespace drtv::reference
