// Triangles as Embree gets them.
#pragma once

#include "bakerd/map/map.h"
#include "bakerd/trace/closed_parts.h"
#include "bakerd/trace/surface.h"
#include "bakerd/trace/triangle.h"

#include <glm/mat4x3.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

struct RTCDeviceTy;
struct RTCSceneTy;

namespace drtv::trace {

// Some triangles of one primitive, in its order: one Embree geometry. What is nowhere there (alpha) is in no
// set.
struct TriangleSet {
    const map::Map* map = nullptr;
    const map::Primitive* primitive = nullptr;
    const map::Material* material = nullptr;
    const ClosedParts* closed = nullptr;  // of its mesh
    std::uint32_t primitive_index = 0;    // in its mesh
    bool mixed = false;                   // there in parts: alpha is looked at, hit by hit
    std::uint32_t instance = UINT32_MAX;  // in its scene; of a set in world space alone
    bool mirrored = false;                // in world space the front is clockwise
    float spread = 1;                     // of its instances, at most (InstanceShape)
    // Of its triangles, in the space of Embree's scene; once attached.
    float longest_edge = 0, farthest_coordinate = 0;
    std::vector<std::uint32_t> triangles;  // of the primitive; empty: all of them, in order

    [[nodiscard]] std::size_t size() const {
        return triangles.empty() ? primitive->triangles.size() : triangles.size();
    }
    [[nodiscard]] std::uint32_t triangle_of(std::uint32_t n) const {
        return triangles.empty() ? n : triangles[n];
    }
    // Of the mesh's closed parts, the one that a triangle of the set belongs to, or none.
    [[nodiscard]] std::uint32_t closed_part_of(std::uint32_t n) const {
        return closed->part_of(primitive_index, triangle_of(n));
    }
    // Whether that part looks outwards.
    [[nodiscard]] bool is_of_body(std::uint32_t n) const {
        const std::uint32_t part = closed_part_of(n);
        return part != ClosedParts::none && closed->part(part).outward;
    }
};

[[nodiscard]] inline ObjectTriangle corners_of(const TriangleSet& set, std::uint32_t triangle_of_set) {
    const glm::uvec3& t = set.primitive->triangles[set.triangle_of(triangle_of_set)];
    const std::vector<glm::vec3>& p = set.primitive->positions;
    return {p[t.x], p[t.y], p[t.z]};
}

[[nodiscard]] inline bool is_decided_by_chance(const TriangleSet& set) {
    return set.mixed && is_partly_there(*set.material);
}

[[nodiscard]] inline TrianglePoint point_of(const TriangleSet& set,
                                            std::uint32_t triangle_of_set,
                                            const Intersection& at) {
    return {*set.map, *set.primitive, set.triangle_of(triangle_of_set), at.u, at.v};
}

// The sets of a mesh, whose closed parts outlive them, in the order of its primitives: of each first what is
// there everywhere, then what is mixed. With `wanted`, of those triangles of a primitive alone for which it
// holds.
using WantedTriangle = std::function<bool(const map::Primitive&, const glm::uvec3&)>;
[[nodiscard]] std::vector<std::unique_ptr<TriangleSet>> triangle_sets(const map::Map& map,
                                                                      const map::Mesh& mesh,
                                                                      const ClosedParts& closed,
                                                                      const WantedTriangle& wanted = {});

// What there is of a kind that asks for more than a hit.
struct Kinds {
    bool glass = false;         // light goes straight through, in its colour
    bool partly_there = false;  // glass or blended
    bool closed = false;        // bounds a volume
    Kinds& operator|=(const Kinds& other) {
        glass = glass || other.glass;
        partly_there = partly_there || other.partly_there;
        closed = closed || other.closed;
        return *this;
    }
};
[[nodiscard]] Kinds kinds_of(std::span<const std::unique_ptr<TriangleSet>> sets);

// Attaches the set to the scene under the id. REQUIRES: the set outlives the scene.
void attach(RTCDeviceTy* device,
            RTCSceneTy* scene,
            TriangleSet& set,
            std::uint32_t id,
            const glm::mat4x3& scene_from_object = glm::mat4x3(1));

}  // namespace drtv::trace
