#include "bakerd/bake/next_event.h"

#include "bakerd/bake/path.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace drtv::bake {

Incident NextEvent::towards(const StaticPointLight& light, const glm::vec3& from) const {
    const glm::vec3 to_light = light.position - from;
    const float distance_m = glm::length(to_light);
    if (!(distance_m > 0))
        return {};
    return {to_light / distance_m, light.irradiance_at(from), light.position, distance_m, 0};
}

Incident NextEvent::towards(const StaticSun& sun, const glm::vec3& from) const {
    return {sun.towards, sun.irradiance, std::nullopt, exit_distance(from, sun.towards, probe_, reach_m_), 0};
}

std::optional<Incident> NextEvent::draw(const glm::vec3& from,
                                        const std::array<double, 3>& u,
                                        const Roulette& roulette) const {
    const LightTree::Drawn drawn = tree_.draw(from, u[0], roulette);
    if (!(drawn.probability > 0))
        return std::nullopt;
    if (drawn.item.point != nullptr) {
        Incident incident = towards(*drawn.item.point, from);
        incident.light /= drawn.probability * drawn.survival;
        return incident;
    }
    const std::vector<EmissiveObject::Triangle>& triangles = drawn.item.emissive->triangles;
    const auto after = std::ranges::upper_bound(
        triangles, static_cast<float>(drawn.rest), {}, &EmissiveObject::Triangle::share_before);
    const EmissiveObject::Triangle& triangle = *(after == triangles.begin() ? after : after - 1);
    // Uniform on the triangle.
    const float root = std::sqrt(static_cast<float>(u[1]));
    const float weight_b = root * (1 - static_cast<float>(u[2]));
    const float weight_c = root * static_cast<float>(u[2]);
    const glm::vec3 point = triangle.a * (1 - root) + triangle.b * weight_b + triangle.c * weight_c;
    const glm::vec3 to_light = point - from;
    const glm::vec3 normal = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
    const float distance_m = glm::length(to_light);
    const float double_area_m2 = glm::length(normal);
    if (!(distance_m > 0) || !(double_area_m2 > 0) || glm::length(point - probe_) > reach_m_)
        return std::nullopt;
    const glm::vec3 direction = to_light / distance_m;
    const float cosine = -glm::dot(direction, normal) / double_area_m2;
    if (!(triangle.both_sides ? cosine != 0 : cosine > 0))
        return std::nullopt;

    const map::Map& map = scene_.map();
    const map::Object& object = map.objects[drawn.item.emissive->object];
    const map::Primitive& primitive = map.meshes[object.mesh].primitives[triangle.primitive];
    const bool mirrored = glm::determinant(glm::mat3(object.world_from_object)) < 0;
    const float u_weight = mirrored ? weight_c : weight_b;
    const float v_weight = mirrored ? weight_b : weight_c;
    const trace::TrianglePoint on_light{map, primitive, triangle.triangle, u_weight, v_weight};
    if (!trace::is_there(on_light))
        return std::nullopt;
    Incident incident{direction, glm::vec3(0), point, distance_m, 0};
    incident.density =
        drawn.probability * triangle.share * 2 / double_area_m2 * distance_m * distance_m / std::abs(cosine);
    incident.light = trace::emission_at(on_light, {double_area_m2, distance_m * first_footprint}) /
                     (lumens_per_watt * incident.density * drawn.survival);
    return incident;
}

float NextEvent::density_of(const glm::vec3& from, const glm::vec3& direction, const trace::Hit& hit) const {
    const LightTree::Drawn drawn = tree_.find(from, scene_.object_index(hit.instance));
    const EmissiveObject::Triangle* triangle =
        drawn.probability > 0 ? drawn.item.emissive->find(hit.primitive, hit.triangle) : nullptr;
    if (triangle == nullptr)
        return 0;
    const float cosine = std::abs(glm::dot(direction, hit.normal));
    return drawn.probability * triangle->share * 2 / hit.double_area_m2 * hit.distance_m * hit.distance_m /
           std::max(cosine, 1e-6f);
}

trace::Ray NextEvent::shadow_ray(const glm::vec3& start, const Incident& incident) {
    if (!incident.target)
        return {start, incident.direction, incident.distance_m};
    // Aimed anew: from a start off the surface, the old direction would miss the light by as much.
    const glm::vec3 way = *incident.target - start;
    const float distance_m = glm::length(way);
    return {start, distance_m > 0 ? way / distance_m : incident.direction, distance_m};
}

}  // namespace drtv::bake
