#pragma once

#include <glm/vec3.hpp>

#include <algorithm>

namespace drtv::map {

// The largest channel.
[[nodiscard]] inline float brightest(const glm::vec3& colour) {
    return std::max({colour.x, colour.y, colour.z});
}

// As bright as a colour looks: Rec. 709.
[[nodiscard]] inline float luminance(const glm::vec3& linear) {
    return 0.2126f * linear.x + 0.7152f * linear.y + 0.0722f * linear.z;
}

}  // namespace drtv::map
