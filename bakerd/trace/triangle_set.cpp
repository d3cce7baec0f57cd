#include "bakerd/trace/triangle_set.h"

#include "bakerd/trace/hit_filter.h"
#include "bakerd/trace/surface.h"

#include <embree3/rtcore.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <tuple>

namespace drtv::trace {
namespace {

std::uint64_t position_hash(const glm::vec3& p) {
    std::uint64_t hash = 0;
    for (glm::length_t k = 0; k < 3; ++k)
        hash = (hash ^ std::bit_cast<std::uint32_t>(p[k])) * 0x9E3779B97F4A7C15u;
    return hash ^ hash >> 29;
}

struct Corners {
    std::uint64_t hash;  // of the corners in any order
    std::uint32_t set, triangle;
    std::array<glm::vec3, 3> at;
};

// The corner of `b` at which it is `a` turned round; nothing where it is not.
std::optional<std::uint8_t> turned_at(const std::array<glm::vec3, 3>& a, const std::array<glm::vec3, 3>& b) {
    for (std::uint8_t k = 0; k < 3; ++k) {
        if (a[0] == b[k] && a[1] == b[(k + 2u) % 3] && a[2] == b[(k + 1u) % 3])
            return k;
    }
    return std::nullopt;
}

void find_twins(std::vector<std::unique_ptr<TriangleSet>>& sets) {
    std::vector<Corners> all;
    for (std::uint32_t s = 0; s < sets.size(); ++s) {
        const TriangleSet& set = *sets[s];
        if (set.material->double_sided)
            continue;
        for (std::uint32_t n = 0; n < set.size(); ++n) {
            const glm::uvec3& t = set.primitive->triangles[set.triangle_of(n)];
            const std::vector<glm::vec3>& p = set.primitive->positions;
            all.push_back({position_hash(p[t.x]) + position_hash(p[t.y]) + position_hash(p[t.z]),
                           s,
                           n,
                           {p[t.x], p[t.y], p[t.z]}});
        }
    }
    // Of several, the first in the order of the content.
    std::ranges::sort(all, {}, [](const Corners& c) { return std::tuple(c.hash, c.set, c.triangle); });
    for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
        while (end < all.size() && all[end].hash == all[first].hash)
            ++end;
        constexpr std::size_t most_alike =
            64;  // of which one is looked for: no sensible mesh has more in one place
        for (std::size_t a = first; end - first > 1 && a < end; ++a) {
            for (std::size_t b = first; b < std::min(end, first + most_alike); ++b) {
                const std::optional<std::uint8_t> corner = turned_at(all[a].at, all[b].at);
                if (!corner)
                    continue;
                TriangleSet& set = *sets[all[a].set];
                const TriangleSet& other = *sets[all[b].set];
                set.twins.resize(set.size());
                set.twins[all[a].triangle] = {
                    other.primitive_index, other.triangle_of(all[b].triangle), *corner};
                break;
            }
        }
    }
}

}  // namespace

std::vector<std::unique_ptr<TriangleSet>> triangle_sets(const map::Map& map,
                                                        const map::Mesh& mesh,
                                                        const WantedTriangle& wanted) {
    std::vector<std::unique_ptr<TriangleSet>> sets;
    for (std::uint32_t n = 0; n < mesh.primitives.size(); ++n) {
        const map::Primitive& primitive = mesh.primitives[n];
        TriangleSet whole;
        whole.map = &map;
        whole.primitive = &primitive;
        whole.material = &map.materials[primitive.material];
        whole.primitive_index = n;
        TriangleSet mixed = whole;
        mixed.mixed = true;
        const auto count = static_cast<std::uint32_t>(primitive.triangles.size());
        if (whole.material->alpha_mode == map::AlphaMode::opaque && !wanted) {
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
    find_twins(sets);
    return sets;
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
