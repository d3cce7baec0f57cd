#include "bakerd/trace/scene.h"

#include "bakerd/trace/query.h"
#include "bakerd/trace/surface.h"

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace drtv::trace {
namespace {

Intersection intersection_of(const HitCandidate& hit, const Scene& scene, const Ray& ray) {
    // It is met: what was sure lies ahead of the start by more than Embree's rays were moved beside the line.
    return hit.at ? *hit.at
                  : *intersect(
                        ray, scene.world_from_object(hit.id.instance), corners_of(*hit.set, hit.id.triangle));
}

float order_of(const HitCandidate& hit, const Intersection& at) {
    return hit.at ? hit.max_m : static_cast<float>(at.distance_m);
}

}  // namespace

const TriangleSet& Scene::set_of(std::uint32_t instance, std::uint32_t embree_geometry) const {
    const MeshBvh* mesh = instances_[instance].mesh;
    return mesh != nullptr ? mesh->set(embree_geometry)
                           : *world_sets_[embree_geometry - map_->objects.size()];
}

std::optional<Hit> Scene::closest(const Ray& ray) const {
    Query query(*this, {&ray, 1});
    Closest& closest = query.closest;
    closest.hit.min_m = closest.hit.max_m = ray.far_m;
    const Sides sides(ray);
    for (int side = 0; side < sides.count; ++side) {
        RTCRayHit r;
        set_ray(r, sides.origin(ray, side), ray.direction, limit_of(ray, closest.hit));
        rtcIntersect1(handle_, &query.base, &r);
    }
    if (closest.hit.set == nullptr)
        return std::nullopt;
    const Intersection at = intersection_of(closest.hit, *this, ray);
    if (!closest.hit.front && closest.front) {
        const Intersection of_front = intersection_of(*closest.front, *this, ray);
        // Within the slack both are known, in whichever order they were found.
        const float back_m = order_of(closest.hit, at);
        if (order_of(*closest.front, of_front) <= back_m + plane_slack(ray, back_m) &&
            in_one_plane(ray, at, of_front))
            return hit_at(*closest.front, of_front, ray);
    }
    if (!closest.hit.front && is_decided_by_chance(*closest.hit.set)) {
        if (const std::optional<Hit> skin = front_skin(closest.hit, at, ray))
            return skin;
    }
    return hit_at(closest.hit, at, ray);
}

// Of a thing of two skins that chance decides of, the coin has fallen for the back. It is one thing: its
// front is met wherever that is, there or not.
std::optional<Hit> Scene::front_skin(const HitCandidate& back, const Intersection& at, const Ray& ray) const {
    if (is_two_sided(*back.set->material, instances_[back.id.instance].role))
        return std::nullopt;
    const float back_m = static_cast<float>(at.distance_m);
    const Ray longer{ray.origin, ray.direction, back_m + plane_slack(ray, back_m)};
    for (const Crossing& crossing : all_crossings(longer, Collected::partly_there)) {
        if (!meets_front(crossing.id.instance, crossing.at, ray) || !in_one_plane(ray, at, crossing.at))
            continue;
        HitCandidate front;
        front.id = crossing.id;
        front.set = &set_of(crossing.id.instance, crossing.id.set);
        return hit_at(front, crossing.at, ray);
    }
    return std::nullopt;
}

Hit Scene::hit_at(const HitCandidate& candidate, const Intersection& at, const Ray& ray) const {
    const double double_area_m2 = glm::length(at.normal);
    const double towards = glm::dot(at.normal, glm::dvec3(ray.direction)) < 0 ? 1 : -1;
    return {static_cast<float>(at.distance_m),
            candidate.id.instance,
            candidate.set->primitive_index,
            candidate.set->triangle_of(candidate.id.triangle),
            at.u,
            at.v,
            candidate.front,
            glm::vec3(at.normal * (towards / double_area_m2)),
            static_cast<float>(double_area_m2),
            candidate.set};
}

// The front is counter-clockwise in object space.
bool Scene::meets_front(std::uint32_t instance, const Intersection& at, const Ray& ray) const {
    return (glm::dot(at.normal, glm::dvec3(ray.direction)) < 0) != instances_[instance].mirrored;
}

// Every triangle that the ray meets and that is wanted, once, in the order of their ids.
std::vector<Crossing> Scene::all_crossings(const Ray& ray, Collected wanted) const {
    std::vector<Crossing> crossings;
    Query query(*this, {&ray, 1});
    query.crossings = &crossings;
    query.collected = wanted;
    // Of a short piece of a ray that grazes a surface too, Embree's error must not lose the hit.
    const float far_m = ray.far_m + query_slack(ray, ray.far_m) + 1;
    const Sides sides(ray);
    for (int side = 0; side < sides.count; ++side) {
        RTCRayHit r;
        set_ray(r, sides.origin(ray, side), ray.direction, far_m);
        rtcIntersect1(handle_, &query.base, &r);
    }
    std::ranges::sort(crossings, {}, &Crossing::id);
    const auto again = std::ranges::unique(crossings, {}, &Crossing::id);
    crossings.erase(again.begin(), again.end());
    return crossings;
}

Ray beside(const Ray& ray) {
    constexpr float breadth = 0x1p-18f;  // radians: 2 mm at 512 m
    const glm::vec3& d = ray.direction;
    const glm::vec3 across = glm::cross(d, std::abs(d.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0));
    return {ray.origin, glm::normalize(d + across * breadth), ray.far_m};
}

Surface Scene::surface(const Hit& hit, float footprint_m) const {
    const map::Role role = instances_[hit.instance].role;
    // What the hit knows already is not looked up again: in a large map that is far away in memory.
    const TrianglePoint point{*hit.set->map, *hit.set->primitive, hit.triangle, hit.u, hit.v};
    return surface_at(point, role, hit.front, {hit.double_area_m2, footprint_m});
}

}  // namespace drtv::trace
