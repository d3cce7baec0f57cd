// What a triangle looks like at a point: whether it is there, and what it does with light.
#pragma once

#include "bakerd/map/map.h"

#include <cstdint>

namespace drtv::trace {

// What a hit does with light; Lambertian all of it. Nothing when `absorbs`.
struct Surface {
    bool absorbs = false;     // the back of a one-sided surface: neither sky nor bounce
    glm::vec3 albedo{};       // linear Rec. 709, sent back
    glm::vec3 transmitted{};  // let through to the other side; with albedo at most map::max_albedo a channel
    glm::vec3 emission{};     // radiance of the side that was hit, nits
};

// Vegetation whose material is thin (double-sided, or cut out by alpha) and says nothing of transmission lets
// through this share of what it sends back: leaves do about that much in visible light.
inline constexpr float leaf_transmission = 0.5f;

// Leaves reflect on both sides, whatever the exporter says, and what lets light through has no blind side.
[[nodiscard]] inline bool is_two_sided(const map::Material& material, map::Role role) {
    return role == map::Role::vegetation || material.double_sided || material.diffuse_transmission > 0 ||
           material.transmission > 0;
}

// Whether it may be there in parts only: alpha is looked at, or clear glass.
[[nodiscard]] inline bool has_holes(const map::Material& material) {
    return material.alpha_mode != map::AlphaMode::opaque || material.transmission > 0;
}

// Whether chance decides where it is there.
[[nodiscard]] inline bool is_partly_there(const map::Material& material) {
    return material.alpha_mode == map::AlphaMode::blend || material.transmission > 0;
}

// A point of a mesh's triangle. Barycentric u, v weigh its second and third vertex.
struct TrianglePoint {
    const map::Map& map;
    const map::Primitive& primitive;
    std::uint32_t triangle;  // of the primitive
    float u;
    float v;

    [[nodiscard]] const map::Material& material() const { return map.materials[primitive.material]; }
    [[nodiscard]] const glm::uvec3& corners() const { return primitive.triangles[triangle]; }
};

// How a point is looked at.
struct RayFootprint {
    float double_area_m2;  // twice the triangle's area in the world
    float width_m;         // over which textures are averaged
};

[[nodiscard]] float alpha_at(const TrianglePoint& point);

// Whether the surface is there: opaque ones are, masked ones by their cutoff, blended ones with the
// probability of their alpha, by a hash of the point: at another point the coin falls anew, at the same one
// never. Where there is clear glass, it is not there with the share of light that it lets straight through in
// the brightest channel: so no path is worth more behind it than before.
[[nodiscard]] bool is_there(const TrianglePoint& point);

// What clear glass does to light that passes it: nothing, where it is alpha that takes the surface away.
// REQUIRES: !is_there(point).
struct GlassPassed {
    glm::vec3 tint{1};   // what the light is multiplied with, at most 1
    glm::vec3 share{1};  // of light that would go the same way again, without chance
};
[[nodiscard]] GlassPassed passed_glass_at(const TrianglePoint& point);

// The share of light that goes straight through at the point, by channel, without chance.
[[nodiscard]] glm::vec3 passed_at(const TrianglePoint& point);

enum class Presence : std::uint8_t { nowhere, mixed, whole };

// Where on the triangle `is_there` holds; mixed when in doubt.
[[nodiscard]] Presence presence_of(const map::Map& map,
                                   const map::Primitive& primitive,
                                   std::uint32_t triangle);

// `front`: seen from there.
[[nodiscard]] Surface surface_at(const TrianglePoint& point,
                                 map::Role role,
                                 bool front,
                                 const RayFootprint& footprint);

// A bound on the share of light that any surface of the map's objects passes on, to both sides together and
// in whichever channels are most: no step of a path (bake::scatter) multiplies what it brings by more. Below
// 1, and never 0: of a black map min_scattered.
inline constexpr float min_scattered = 1 / 16.0f;
[[nodiscard]] float max_scattered(const map::Map& map);

// Radiance of the triangle's front at a point, nits; as surface_at has it.
[[nodiscard]] glm::vec3 emission_at(const TrianglePoint& point, const RayFootprint& footprint);

}  // namespace drtv::trace
