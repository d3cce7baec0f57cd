// What a triangle looks like at a point: alpha and albedo from factor, texture and vertex colour.
#pragma once

#include "bakerd/map/map.h"

namespace drtv::trace {

// Barycentric u, v weigh the triangle's second and third vertex.
[[nodiscard]] float alpha_at(const map::Map& map, const map::Primitive& primitive, std::uint32_t triangle, float u, float v);

// Linear, each channel in [0, map::max_albedo].
[[nodiscard]] glm::vec3 albedo_at(const map::Map& map, const map::Primitive& primitive, std::uint32_t triangle, float u, float v);

}  // namespace drtv::trace
