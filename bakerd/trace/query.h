// What Embree is asked with, and what a filter function and its caller share during one query.
#pragma once

#include "bakerd/trace/ray.h"
#include "bakerd/trace/triangle.h"
#include "bakerd/trace/triangle_set.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace drtv::trace {

class Scene;

// Where a ray starts for Embree: moved by some roundings where it runs along an axis. Such rays start on the lattice to which kits
// are snapped, and of one that runs along the side of a box with the larger coordinates Embree says that it leaves the box at once; what
// touches there may be turned, so that this is its larger side as well, or rounded away by its transform. It matters to which triangles are
// found, not to where they are met.
[[nodiscard]] inline float off_lattice(float origin, float direction) {
    constexpr float along_axis = 0x1p-20f;
    return std::abs(direction) > along_axis ? origin : origin - std::copysign((std::abs(origin) + 64) * 0x1p-22f, origin);
}

// Both are filled in place: a copy of what was just written number by number waits for all of it.
inline void set_ray(RTCRay& r, const Ray& ray, unsigned id = 0) {
    r.org_x = off_lattice(ray.origin.x, ray.direction.x);
    r.org_y = off_lattice(ray.origin.y, ray.direction.y);
    r.org_z = off_lattice(ray.origin.z, ray.direction.z);
    r.tnear = 0;
    r.dir_x = ray.direction.x;
    r.dir_y = ray.direction.y;
    r.dir_z = ray.direction.z;
    r.time = 0;
    r.tfar = ray.far_m + query_slack(ray, ray.far_m);
    r.mask = ~0u;
    r.id = id;
    r.flags = 0;
}

inline void set_ray(RTCRayHit& r, const Ray& ray) {
    set_ray(r.ray, ray);
    r.hit.geomID = r.hit.primID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

// Which triangle, in Embree's numbers: instance in the scene, triangle set of its mesh, triangle of the set. All three
// follow the order of the content (TriangleSet), so that the smaller one does too.
struct TriangleId {
    std::uint32_t instance = 0, set = 0, triangle = 0;
    auto operator<=>(const TriangleId&) const = default;
};

struct Crossing {
    TriangleId id;
    Intersection at;
};

// The closest hit so far, or the end of the ray. Where Embree's own distance decides, the intersection is left for later.
struct Candidate {
    TriangleId id;
    const TriangleSet* set = nullptr;  // none: the end of the ray
    float least_m = 0, most_m = 0;     // order_of lies between them
    std::optional<Intersection> at;    // if worked out; then both are order_of
};

// REQUIRES: `base` stays the first member, Embree hands back a pointer to it.
struct Query {
    RTCIntersectContext base;
    const Scene& scene;
    std::span<const Ray> rays;  // in the world, by RTCRay::id: an instance's filter gets them in its own space
    Candidate best;             // of `rays[0]`
    std::vector<Crossing>* crossings = nullptr;  // collect every hit instead of the closest

    Query(const Scene& asked, std::span<const Ray> asked_rays) : scene(asked), rays(asked_rays) { rtcInitIntersectContext(&base); }
};

}  // namespace drtv::trace
