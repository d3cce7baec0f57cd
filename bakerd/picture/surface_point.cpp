#include "bakerd/picture/surface_point.h"

#include "bakerd/bake/lights.h"
#include "bakerd/bake/path.h"
#include "bakerd/picture/vectors.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace drtv::picture {

std::optional<SurfacePoint> surface_on(const trace::Scene& scene,
                                       const Camera& camera,
                                       const trace::Ray& ray) {
    const std::optional<trace::Hit> hit = scene.closest(ray);
    if (!hit)
        return std::nullopt;
    SurfacePoint point;
    point.ray = ray;
    point.hit = *hit;
    point.surface = scene.surface(*hit, camera.pixel_m(hit->distance_m));
    point.at = ray.origin + ray.direction * hit->distance_m;
    point.tint = scene.passed({ray.origin, ray.direction, hit->distance_m}).tint;
    return point;
}

Incidence incidence(const PointLight& lamp, const glm::vec3& at) {
    const glm::vec3 place(lamp.position[0], lamp.position[1], lamp.position[2]);
    const bake::StaticPointLight light{.position = place, .intensity = as_vec(lamp.intensity)};
    const glm::vec3 way = place - at;
    const float distance_m = glm::length(way);
    if (!(distance_m > 0))
        return {};
    return {way / distance_m, light.irradiance_at(at), place};
}

glm::vec3 scattered(const trace::Scene& scene, const SurfacePoint& point, const Incidence& light) {
    const float cosine = glm::dot(point.hit.normal, light.direction);
    const bool through = cosine < 0;
    const glm::vec3 share = through ? point.surface.transmitted : point.surface.albedo;
    const glm::vec3 sent = share * light.irradiance * (std::abs(cosine) * std::numbers::inv_pi_v<float>);
    if (sent == glm::vec3(0))
        return sent;
    const std::optional<glm::vec3> start = through ? bake::beyond_surface(scene, point.ray, point.hit)
                                                   : bake::before_surface(point.ray, point.hit);
    if (!start)
        return glm::vec3(0);
    trace::Ray shadow{*start, light.direction, sight_m};
    if (light.place) {
        // Aimed anew: the start lies off the surface.
        const glm::vec3 way = *light.place - *start;
        shadow.far_m = glm::length(way);
        shadow.direction = shadow.far_m > 0 ? way / shadow.far_m : light.direction;
    }
    return sent * scene.share_seen(shadow, light.place.has_value());
}

}  // namespace drtv::picture
