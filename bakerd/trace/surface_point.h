// What a point of a triangle wears: for the files that say what surfaces do. Here for inlining.
#pragma once

#include "bakerd/map/map.h"
#include "bakerd/trace/surface.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace drtv::trace {

template <class Value>
[[nodiscard]] Value interpolate(const std::vector<Value>& values, const TrianglePoint& point) {
    const glm::uvec3& t = point.corners();
    return values[t.x] * (1 - point.u - point.v) + values[t.y] * point.u + values[t.z] * point.v;
}

[[nodiscard]] inline glm::vec2 viewed(const map::TextureView& view, const glm::vec2& uv) {
    const glm::vec3 row(uv, 1);
    return {glm::dot(view.u_from_uv, row), glm::dot(view.v_from_uv, row)};
}

// The base colour with the picture itself, not as wide as a footprint: what chance depends on must not.
[[nodiscard]] glm::vec3 unfiltered_colour(const TrianglePoint& point);

// The share of what is there that is clear glass.
[[nodiscard]] float clear_share(const TrianglePoint& point);

}  // namespace drtv::trace
