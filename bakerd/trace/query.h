// What Embree is asked with, and what a filter function and its caller share during one query.
#pragma once

#include "bakerd/trace/scene.h"

#include <embree3/rtcore.h>

#include <compare>
#include <cstdint>
#include <limits>
#include <vector>

namespace drtv::trace {

[[nodiscard]] inline RTCRay embree_ray(const Ray& ray) {
    RTCRay r{};
    r.org_x = ray.origin.x;
    r.org_y = ray.origin.y;
    r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x;
    r.dir_y = ray.direction.y;
    r.dir_z = ray.direction.z;
    r.tfar = ray.far_m;
    r.mask = ~0u;
    return r;
}

// Which triangle, in Embree's numbers: instance in the scene, triangle set of its mesh, triangle of the set. All three
// follow the order of the content (TriangleSet), so that the smaller one does too.
struct TriangleId {
    std::uint32_t instance = 0, set = 0, triangle = 0;
    auto operator<=>(const TriangleId&) const = default;
};

struct Crossing {
    float distance = 0;
    TriangleId id;
    float facing = 0;  // direction . normal in object space: negative is the front
};

// REQUIRES: `base` stays the first member, Embree hands back a pointer to it.
struct Query {
    RTCIntersectContext base;
    float best_distance = std::numeric_limits<float>::infinity();
    TriangleId best;
    std::vector<Crossing>* crossings = nullptr;  // collect every hit instead of the closest

    Query() { rtcInitIntersectContext(&base); }
};

}  // namespace drtv::trace
