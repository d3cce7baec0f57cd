#include "bakerd/trace/hit_filter.h"

#include "bakerd/trace/query.h"
#include "bakerd/trace/scene.h"
#include "bakerd/trace/surface.h"

#include <cassert>
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

// Works the intersection out; what is met nowhere lies infinitely far.
void resolve(Candidate& hit, const Query& query, const Ray& ray) {
    const glm::mat4x3& world_from_object = query.scene.world_from_object(hit.id.instance);
    const ObjectTriangle corners = corners_of(*hit.set, hit.id.triangle);
    hit.at = intersect(ray, world_from_object, corners);
    const float order_m = hit.at ? order_of(*hit.set, *hit.at, ray, world_from_object, corners)
                                 : std::numeric_limits<float>::infinity();
    hit.least_m = hit.most_m = order_m;
}

bool is_there(const Candidate& hit) {
    return !hit.set->mixed || trace::is_there({*hit.set->map,
                                               *hit.set->primitive,
                                               hit.set->triangle_of(hit.id.triangle),
                                               hit.at->u,
                                               hit.at->v});
}

// Of two at the same distance the one of the smaller id is nearer.
bool is_nearer(const Candidate& a, const Candidate& b) {
    return a.most_m < b.most_m || (a.most_m == b.most_m && (b.set == nullptr || a.id < b.id));
}

// What lies farther is not looked at any more.
void accept(const RTCFilterFunctionNArguments& args, const Ray& ray, float order_m) {
    RTCRayN_tfar(args.ray, 1, 0) = order_m + query_slack(ray, order_m);
    args.valid[0] = -1;
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
        Candidate hit{id, &set, 0, 0, {}};
        resolve(hit, query, ray);
        if (hit.at && hit.at->distance_m <= double{ray.far_m} && is_there(hit))
            query.crossings->push_back({id, *hit.at});
        return;
    }
    const EmbreeHit offered = embree_hit(*args, set, 1, 0);
    if (!set.mixed && is_sure(ray, offered)) {
        const float doubt_m = query_slack(ray, offered.distance_m) * 0.5f;
        const float least_m = offered.distance_m - doubt_m;
        const float most_m = offered.distance_m + doubt_m;
        if (least_m > query.best.most_m)
            return;
        if (most_m < query.best.least_m) {
            query.best.id = id;
            query.best.set = &set;
            query.best.least_m = least_m;
            query.best.most_m = most_m;
            query.best.at.reset();
            // For when the intersection is worked out.
            __builtin_prefetch(&set.primitive->triangles[set.triangle_of(id.triangle)]);
            __builtin_prefetch(&query.scene.world_from_object(id.instance));
            accept(*args, ray, most_m);
            return;
        }
    }
    Candidate hit{id, &set, 0, 0, {}};
    resolve(hit, query, ray);
    if (query.best.set != nullptr && !query.best.at)
        resolve(query.best, query, ray);
    if (!hit.at || !is_nearer(hit, query.best) || !is_there(hit))
        return;
    query.best = hit;
    accept(*args, ray, hit.most_m);
}

void occluded_filter(const RTCFilterFunctionNArguments* args) {
    const auto& query = *reinterpret_cast<const Query*>(args->context);
    const auto& set = *static_cast<const TriangleSet*>(args->geometryUserPtr);
    for (unsigned n = 0; n < args->N; ++n) {
        if (args->valid[n] != -1)
            continue;
        const Ray& ray = query.rays[RTCRayN_id(args->ray, args->N, n)];
        const TriangleId id = id_of(*args, set, args->N, n);
        if (!set.mixed) {
            const EmbreeHit offered = embree_hit(*args, set, args->N, n);
            if (offered.distance_m + query_slack(ray, offered.distance_m) < ray.far_m &&
                is_sure(ray, offered))
                continue;
        }
        Candidate hit{id, &set, 0, 0, {}};
        resolve(hit, query, ray);
        if (!hit.at || hit.most_m > ray.far_m || !is_there(hit))
            args->valid[n] = 0;
    }
}

}  // namespace drtv::trace
