#pragma once

#include <glm/vec3.hpp>

#include <algorithm>

namespace drtv::map {

// The largest channel.
[[nodiscard]] inline float brightest(const glm::vec3& colour) {
    return std::max({colour.x, colour.y, colour.z});
}

}  // namespace drtv::map
