// Boxes around what changed, against points and rays.
#pragma once

#include "bakerd/map/map.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace drtv::reuse {

using map::Bounds;

// How far coordinates of rays and of things may be wrong together, with a good reserve.
[[nodiscard]] inline float slack_m(const Bounds& bounds, float reach_m) {
    const glm::vec3 farthest = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    return 0.02f + (std::max({farthest.x, farthest.y, farthest.z}) + reach_m) * 0x1p-17f;
}

[[nodiscard]] inline Bounds grown(const Bounds& bounds, const glm::vec3& by) {
    return {bounds.low - by, bounds.high + by};
}

[[nodiscard]] inline bool overlap(const Bounds& a, const Bounds& b) {
    const auto on_axis = [&](glm::length_t k) { return a.low[k] <= b.high[k] && b.low[k] <= a.high[k]; };
    return on_axis(0) && on_axis(1) && on_axis(2);
}

[[nodiscard]] inline float distance(const Bounds& bounds, const glm::vec3& point) {
    return glm::length(point - glm::clamp(point, bounds.low, bounds.high));
}

// A part of a ray, in metres along it.
struct RayPart {
    float from;
    float to;
};

// Where a ray is between two planes across an axis.
[[nodiscard]] inline RayPart between_planes(float low, float high, float origin, float direction) {
    // Never quite along them: no division gives a number that is none.
    const float inverse = 1 / (std::abs(direction) < 1e-12f ? 1e-12f : direction);
    const float a = (low - origin) * inverse;
    const float b = (high - origin) * inverse;
    return {std::min(a, b), std::max(a, b)};
}

// The distance at which a ray enters a box; infinity when it passes it by.
[[nodiscard]] inline float entry_distance(const glm::vec3& origin,
                                          const glm::vec3& direction,
                                          const Bounds& box) {
    float enter = 0;
    float leave = std::numeric_limits<float>::infinity();
    for (glm::length_t k = 0; k < 3; ++k) {
        const RayPart inside = between_planes(box.low[k], box.high[k], origin[k], direction[k]);
        enter = std::max(enter, inside.from);
        leave = std::min(leave, inside.to);
    }
    return enter <= leave ? enter : std::numeric_limits<float>::infinity();
}

}  // namespace drtv::reuse
