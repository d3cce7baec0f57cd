#include "bakerd/trace/triangle_set.h"

#include "bakerd/trace/hit_filter.h"
#include "bakerd/trace/surface.h"

#include <embree3/rtcore.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace drtv::trace {

std::vector<std::unique_ptr<TriangleSet>> triangle_sets(const map::Map& map,
                                                        const map::Mesh& mesh,
                                                        const ClosedParts& closed,
                                                        const WantedTriangle& wanted) {
    std::vector<std::unique_ptr<TriangleSet>> sets;
    for (std::uint32_t n = 0; n < mesh.primitives.size(); ++n) {
        const map::Primitive& primitive = mesh.primitives[n];
        TriangleSet whole;
        whole.map = &map;
        whole.primitive = &primitive;
        whole.material = &map.materials[primitive.material];
        whole.closed = &closed;
        whole.primitive_index = n;
        TriangleSet mixed = whole;
        mixed.mixed = true;
        const auto count = static_cast<std::uint32_t>(primitive.triangles.size());
        if (!has_holes(*whole.material) && !wanted) {
            sets.push_back(std::make_unique<TriangleSet>(std::move(whole)));
            continue;
        }
        for (std::uint32_t t = 0; t < count; ++t) {
            if (wanted && !wanted(primitive, primitive.triangles[t]))
                continue;
            const Presence presence = presence_of(map, primitive, t);
            if (presence == Presence::whole)
                whole.triangles.push_back(t);
            else if (presence == Presence::mixed)
                mixed.triangles.push_back(t);
        }
        for (TriangleSet* set : {&whole, &mixed}) {
            if (!set->triangles.empty())
                sets.push_back(std::make_unique<TriangleSet>(std::move(*set)));
        }
    }
    return sets;
}

Kinds kinds_of(std::span<const std::unique_ptr<TriangleSet>> sets) {
    Kinds kinds;
    for (const auto& set : sets)
        kinds |= {set->material->transmission > 0, is_partly_there(*set->material), !set->closed->empty()};
    return kinds;
}

void attach(RTCDeviceTy* device,
            RTCSceneTy* scene,
            TriangleSet& set,
            std::uint32_t id,
            const glm::mat4x3& scene_from_object) {
    const map::Primitive& primitive = *set.primitive;
    const auto count = static_cast<std::uint32_t>(set.size());
    // Corners stay shared: the robust test gives an edge one sign for both its triangles only where their
    // vertices are the same. Those that the set does not use are left out.
    std::vector<bool> marked(primitive.positions.size(), false);
    for (std::uint32_t n = 0; n < count; ++n) {
        for (glm::length_t k = 0; k < 3; ++k)
            marked[primitive.triangles[set.triangle_of(n)][k]] = true;
    }
    std::vector<std::uint32_t> used;
    std::vector<std::uint32_t> number(primitive.positions.size());
    for (std::uint32_t n = 0; n < marked.size(); ++n) {
        number[n] = static_cast<std::uint32_t>(used.size());
        if (marked[n])
            used.push_back(n);
    }
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Embree's own buffers, because it reads some bytes past the last vertex.
    auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), used.size()));
    auto* indices = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), count));
    const glm::dmat4x3 transform(scene_from_object);
    for (std::size_t n = 0; n < used.size(); ++n)
        vertices[n] = glm::vec3(transform * glm::dvec4(primitive.positions[used[n]], 1));
    for (std::uint32_t n = 0; n < count; ++n) {
        const glm::uvec3& t = primitive.triangles[set.triangle_of(n)];
        indices[n] = {number[t.x], number[t.y], number[t.z]};
        for (glm::length_t k = 0; k < 3; ++k) {
            const glm::vec3 corner = glm::abs(vertices[indices[n][k]]);
            set.farthest_coordinate = std::max({set.farthest_coordinate, corner.x, corner.y, corner.z});
        }
        const glm::vec3 &a = vertices[number[t.x]], &b = vertices[number[t.y]], &c = vertices[number[t.z]];
        set.longest_edge =
            std::max({set.longest_edge, glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    }
    set.longest_edge *= 1 + 0x1p-20f;  // the lengths are rounded
    rtcSetGeometryUserData(geometry, &set);
    rtcSetGeometryIntersectFilterFunction(geometry, intersect_filter);
    rtcSetGeometryOccludedFilterFunction(geometry, occluded_filter);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

}  // namespace drtv::trace
