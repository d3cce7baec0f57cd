#include "bakerd/trace/hit_filter.h"

#include "bakerd/trace/query.h"
#include "bakerd/trace/scene.h"
#include "bakerd/trace/surface.h"

#include <glm/geometric.hpp>

#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

namespace drtv::trace {
namespace {

// `size` is that of the packet: where it is a constant, so are the offsets.
TriangleId id_of(const RTCFilterFunctionNArguments& args, const TriangleSet& set, unsigned size, unsigned n) {
    TriangleId id{RTCHitN_instID(args.hit, size, n, 0),
                  RTCHitN_geomID(args.hit, size, n),
                  RTCHitN_primID(args.hit, size, n)};
    if (id.instance == RTC_INVALID_GEOMETRY_ID)
        id.instance = set.instance;
    return id;
}

EmbreeHit embree_hit(const RTCFilterFunctionNArguments& args,
                     const TriangleSet& set,
                     unsigned size,
                     unsigned n) {
    return {
        RTCRayN_tfar(args.ray, size, n),
        {RTCRayN_dir_x(args.ray, size, n),
         RTCRayN_dir_y(args.ray, size, n),
         RTCRayN_dir_z(args.ray, size, n)},
        {RTCHitN_Ng_x(args.hit, size, n), RTCHitN_Ng_y(args.hit, size, n), RTCHitN_Ng_z(args.hit, size, n)},
        set.longest_edge,
        set.farthest_coordinate,
        set.spread};
}

// In the space in which Embree tested the triangle: that is where it rounded.
float order_of(const TriangleSet& set,
               const Intersection& at,
               const Ray& ray,
               const glm::mat4x3& world_from_object,
               const ObjectTriangle& corners) {
    const bool in_world_space = set.instance != UINT32_MAX;
    if (!in_world_space)
        return order_of(at, ray, world_from_object, corners);
    const Triangle world = transformed(world_from_object, corners);
    const glm::vec3 a(world.a);
    const glm::vec3 b(world.b);
    const glm::vec3 c(world.c);
    return order_of(at, ray, glm::mat4x3(1), {a, b, c});
}

// In the space of the object the front is counter-clockwise, however the object is turned over.
bool meets_front(const TriangleSet& set, const EmbreeHit& hit) {
    const float facing =
        hit.normal.x * hit.direction.x + hit.normal.y * hit.direction.y + hit.normal.z * hit.direction.z;
    return (facing < 0) != set.mirrored;
}

// Works the intersection out; what is met nowhere lies infinitely far.
void resolve(HitCandidate& hit, const Query& query, const Ray& ray) {
    const glm::mat4x3& world_from_object = query.scene.world_from_object(hit.id.instance);
    const ObjectTriangle corners = corners_of(*hit.set, hit.id.triangle);
    hit.at = intersect(ray, world_from_object, corners);
    const float order_m = hit.at ? order_of(*hit.set, *hit.at, ray, world_from_object, corners)
                                 : std::numeric_limits<float>::infinity();
    hit.min_m = hit.max_m = order_m;
    hit.front = hit.at && query.scene.meets_front(hit.id.instance, *hit.at, ray);
}

void resolve_late(HitCandidate& hit, const Query& query, const Ray& ray) {
    if (hit.set != nullptr && !hit.at)
        resolve(hit, query, ray);
}

bool is_there(const HitCandidate& hit) {
    return !hit.set->mixed || trace::is_there(point_of(*hit.set, hit.id.triangle, *hit.at));
}

// By what the triangle belongs to, before the hit is looked at.
bool may_be_wanted(const HitCandidate& found, const Query& query) {
    const TriangleSet& set = *found.set;
    switch (query.collected) {
        case Collected::there:
            return true;
        case Collected::of_static:
            return query.scene.role_of(found.id.instance) != map::Role::vegetation;
        case Collected::of_spaces:
            return query.scene.role_of(found.id.instance) != map::Role::vegetation ||
                   set.closed_part_of(found.id.triangle) != ClosedParts::none;
        case Collected::closed:
            return set.closed_part_of(found.id.triangle) != ClosedParts::none;
        case Collected::through_glass:
            return set.material->transmission > 0;
        case Collected::partly_there:
            return is_decided_by_chance(set);
    }
    return false;
}

bool is_wanted(const HitCandidate& hit, Collected wanted) {
    if (wanted == Collected::partly_there || wanted == Collected::closed)
        return true;
    return is_there(hit) != (wanted == Collected::through_glass);
}

// Whether it hides what lies behind.
bool is_in_the_way(const HitCandidate& hit, const Query& query) {
    return (query.by_chance || !is_decided_by_chance(*hit.set)) && is_there(hit);
}

// Of two at the same distance the one of the smaller id is nearer.
bool is_nearer(const HitCandidate& a, const HitCandidate& b) {
    return a.max_m < b.max_m || (a.max_m == b.max_m && (b.set == nullptr || a.id < b.id));
}

// What lies farther is not looked at any more.
void accept(const RTCFilterFunctionNArguments& args, const Ray& ray, const HitCandidate& hit) {
    RTCRayN_tfar(args.ray, 1, 0) = limit_of(ray, hit);
    args.valid[0] = -1;
}

// The triangle's intersection for who asked for all of them.
void collect(const HitCandidate& found, const Query& query, const Ray& ray) {
    if (!may_be_wanted(found, query))
        return;
    HitCandidate hit = found;
    resolve(hit, query, ray);
    if (hit.at && hit.at->distance_m <= double{ray.far_m} && is_wanted(hit, query.collected))
        query.crossings->push_back({hit.id, *hit.at});
}

void consider(const RTCFilterFunctionNArguments& args, HitCandidate hit, Query& query, const Ray& ray) {
    Closest& closest = query.closest;
    resolve(hit, query, ray);
    resolve_late(closest.hit, query, ray);
    if (!hit.at)
        return;
    if (is_nearer(hit, closest.hit)) {
        if (!is_there(hit))
            return;
        closest.place_of_closer(hit.front, hit.max_m, ray) = hit;
        accept(args, ray, hit);
    } else if (hit.front && !closest.hit.front) {
        if (closest.front)
            resolve_late(*closest.front, query, ray);
        const bool is_first = !closest.front || is_nearer(hit, *closest.front);
        if (is_first && hit.max_m <= ray.far_m && is_there(hit))
            closest.front = hit;
    }
}

}  // namespace

void intersect_filter(const RTCFilterFunctionNArguments* args) {
    assert(args->N == 1);
    if (args->valid[0] != -1)
        return;
    args->valid[0] = 0;
    auto& query = *reinterpret_cast<Query*>(args->context);
    const Ray& ray = query.rays[0];
    const auto& set = *static_cast<const TriangleSet*>(args->geometryUserPtr);
    const TriangleId id = id_of(*args, set, 1, 0);
    if (query.crossings != nullptr) {
        collect({id, &set, 0, 0, true, {}}, query, ray);
        return;
    }
    const EmbreeHit offered = embree_hit(*args, set, 1, 0);
    if (!set.mixed && is_sure(ray, offered)) {
        const float doubt_m = query_slack(ray, offered.distance_m) * 0.5f;
        const float min_m = offered.distance_m - doubt_m;
        const float max_m = offered.distance_m + doubt_m;
        // Nearer, the ray may start beyond it.
        const bool ahead = min_m > 0;
        const bool front = meets_front(set, offered);
        const HitCandidate& closest = query.closest.hit;
        if (min_m > closest.max_m && (closest.front || !front))
            return;
        if (ahead && max_m < closest.min_m) {
            HitCandidate& closer = query.closest.place_of_closer(front, max_m, ray);
            closer.id = id;
            closer.set = &set;
            closer.min_m = min_m;
            closer.max_m = max_m;
            closer.front = front;
            closer.at.reset();
            // For when the intersection is worked out.
            __builtin_prefetch(&set.primitive->triangles[set.triangle_of(id.triangle)]);
            __builtin_prefetch(&query.scene.world_from_object(id.instance));
            accept(*args, ray, closer);
            return;
        }
    }
    consider(*args, {id, &set, 0, 0, true, {}}, query, ray);
}

// The plane is met nowhere else, so that this is what the ray ends on.
bool holds_end(const Ray& ray, const TriangleSet& set, const Crossing& crossing, const Scene& scene) {
    const Triangle triangle =
        transformed(scene.world_from_object(crossing.id.instance), corners_of(set, crossing.id.triangle));
    const glm::dvec3 end = glm::dvec3(ray.origin) + glm::dvec3(ray.direction) * double{ray.far_m};
    const glm::dvec3& normal = crossing.at.normal;
    const double across = std::abs(glm::dot(normal, end - triangle.a));
    return across <= static_cast<double>(rounding_m(ray, ray.far_m)) * glm::length(normal);
}

void occluded_filter(const RTCFilterFunctionNArguments* args) {
    auto& query = *reinterpret_cast<Query*>(args->context);
    const auto& set = *static_cast<const TriangleSet*>(args->geometryUserPtr);
    for (unsigned n = 0; n < args->N; ++n) {
        if (args->valid[n] != -1)
            continue;
        const Ray& ray = query.rays[RTCRayN_id(args->ray, args->N, n)];
        const TriangleId id = id_of(*args, set, args->N, n);
        if (query.to_separate && (set.mixed || query.scene.role_of(id.instance) == map::Role::vegetation)) {
            args->valid[n] = 0;
            continue;
        }
        if (!set.mixed) {
            const EmbreeHit offered = embree_hit(*args, set, args->N, n);
            const float doubt_m = query_slack(ray, offered.distance_m);
            const float max_m = offered.distance_m + doubt_m;
            // Nearer to the end, a surface may be the one on which the ray ends.
            const float sure_m = query.to_surface ? ray.far_m * (1 - 0x1p-6f) : ray.far_m;
            // Near the start, the ray may start beyond it.
            if (offered.distance_m > doubt_m && max_m < sure_m && is_sure(ray, offered))
                continue;
        }
        HitCandidate hit{id, &set, 0, 0, true, {}};
        resolve(hit, query, ray);
        // By rounding it may be met beyond the end.
        const bool ends_here = query.to_surface && hit.at && holds_end(ray, set, {id, *hit.at}, query.scene);
        query.ends_on_back = query.ends_on_back || (ends_here && !hit.front);
        const bool hides = !ends_here && hit.at && hit.max_m <= ray.far_m && is_in_the_way(hit, query);
        if (!hides)
            args->valid[n] = 0;
    }
}

}  // namespace drtv::trace
