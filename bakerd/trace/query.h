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

// A ray along an axis starts, and goes on, on the lattice to which kits are snapped. Of one that runs along
// the side of a box with the larger coordinates Embree says that it leaves the box at once; what touches
// there may be turned, so that this is its larger side as well, or be moved by rounding. So such rays are
// asked for some roundings to both sides of the line. This decides which triangles are found, not where they
// are met.
struct Sides {
    int count = 1;        // 1, 2 or 4: neighbours of the line to ask for
    glm::vec3 step_m{0};  // from the line, along the axes to which it is parallel; otherwise 0

    explicit Sides(const Ray& ray) {
        constexpr float along_axis = 0x1p-20f;
        for (glm::length_t k = 0; k < 3; ++k) {
            if (std::abs(ray.direction[k]) > along_axis)
                continue;
            step_m[k] = (std::abs(ray.origin[k]) + 64) * 0x1p-22f;
            count *= 2;
        }
    }
    [[nodiscard]] glm::vec3 origin(const Ray& ray, int side) const {
        if (count == 1)
            return ray.origin;
        glm::vec3 moved = ray.origin;
        for (glm::length_t k = 0, bit = 0; k < 3; ++k) {
            if (step_m[k] > 0)
                moved[k] += (side >> bit++ & 1) == 0 ? step_m[k] : -step_m[k];
        }
        return moved;
    }
};

// Both are filled in place: a copy of what was just written number by number waits for all of it.
inline void set_ray(
    RTCRay& r, const glm::vec3& origin, const glm::vec3& direction, float far_m, unsigned id = 0) {
    r.org_x = origin.x;
    r.org_y = origin.y;
    r.org_z = origin.z;
    r.tnear = 0;
    r.dir_x = direction.x;
    r.dir_y = direction.y;
    r.dir_z = direction.z;
    r.time = 0;
    r.tfar = far_m;
    r.mask = ~0u;
    r.id = id;
    r.flags = 0;
}

inline void set_ray(RTCRayHit& r, const glm::vec3& origin, const glm::vec3& direction, float far_m) {
    set_ray(r.ray, origin, direction, far_m);
    r.hit.geomID = r.hit.primID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

// Which triangle, in Embree's numbers: instance in the scene, triangle set of its mesh, triangle of the set.
// All three follow the order of the content (TriangleSet), so that the smaller one does too.
struct TriangleId {
    std::uint32_t instance = 0;
    std::uint32_t set = 0;
    std::uint32_t triangle = 0;
    auto operator<=>(const TriangleId&) const = default;
};

struct Crossing {
    TriangleId id;
    Intersection at;
};

// A hit, or the end of the ray. Where Embree's own distance decides, the intersection is left for later.
struct HitCandidate {
    TriangleId id;
    const TriangleSet* set = nullptr;  // none: the end of the ray
    float min_m = 0, max_m = 0;        // order_of lies between them
    bool front = true;                 // the ray met the counter-clockwise side
    std::optional<Intersection> at;    // if worked out; then both are order_of
};

// How far behind a back a front can be in its plane: rounding across, of rays at more than a quarter of a
// degree to it.
[[nodiscard]] inline float plane_slack(const Ray& ray, float back_m) {
    return query_slack(ray, back_m);
}

// How far Embree is asked to look when this is the closest so far.
[[nodiscard]] inline float limit_of(const Ray& ray, const HitCandidate& closest) {
    const float limit_m = closest.max_m + query_slack(ray, closest.max_m);
    return closest.front ? limit_m : limit_m + plane_slack(ray, closest.max_m);
}

// The closest hit so far. The front of a surface in whose plane the back of another lies is what a ray meets
// of both, whichever rounding makes the closer one: the walls of rooms touch that way. So as long as the
// closest is a back, the closest front behind it is kept as well.
struct Closest {
    HitCandidate hit;                   // before there is one: the end of the ray
    std::optional<HitCandidate> front;  // says something only while `hit` is a back

    // Where a closer one goes, which is at most so far.
    [[nodiscard]] HitCandidate& place_of_closer(bool is_front, float max_m, const Ray& ray) {
        if (is_front || !hit.front)
            return hit;
        front.reset();
        if (hit.set != nullptr && hit.min_m <= max_m + plane_slack(ray, max_m))
            front = hit;
        return hit;
    }
};

enum class Collected : std::uint8_t {
    there,          // what is there (is_there)
    of_static,      // the same of what is not vegetation
    of_spaces,      // the same, and what bounds a volume (ClosedParts)
    closed,         // the latter alone
    through_glass,  // clear glass that is not there
    partly_there    // what chance decides of, whether it is there or not
};

// REQUIRES: `base` stays the first member, Embree hands back a pointer to it.
struct Query {
    RTCIntersectContext base;
    const Scene& scene;
    std::span<const Ray>
        rays;         // in the world, by RTCRay::id: an instance's filter gets them in its own space
    Closest closest;  // of `rays[0]`
    // Collect hits instead of looking for the closest.
    std::vector<Crossing>* crossings = nullptr;
    Collected collected = Collected::there;
    bool by_chance = true;  // occlusion: what is partly there hides by a coin; else not at all
    // Occlusion: rays end on surfaces, which do not hide that end.
    bool to_surface = false;
    bool ends_on_back = false;  // said of one that ends on a back
    // Occlusion: what separates spaces alone, which is static and there everywhere.
    bool to_separate = false;

    Query(const Scene& asked, std::span<const Ray> asked_rays) : scene(asked), rays(asked_rays) {
        rtcInitIntersectContext(&base);
    }
};

// Whether the end of the ray lies in the plane of a triangle that it crosses.
[[nodiscard]] bool holds_end(const Ray& ray,
                             const TriangleSet& set,
                             const Crossing& crossing,
                             const Scene& scene);

}  // namespace drtv::trace
