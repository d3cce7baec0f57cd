#include "bakerd/bake/path.h"

#include "bakerd/map/colour.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drtv::bake {
namespace {

// How far along the ray the coordinates' rounding reaches around the hit.
float clearance_along(const trace::Ray& ray, const trace::Hit& hit) {
    return trace::rounding_m(ray, hit.distance_m) / -glm::dot(ray.direction, hit.normal);
}

}  // namespace

// A point of the way, which is known to be free. Where the whole way runs closer to the surface than the
// rounding (in the last micrometres of a crevice) the path ends: better a path lost than light through a
// wall.
std::optional<glm::vec3> before_surface(const trace::Ray& ray, const trace::Hit& hit) {
    const float back = clearance_along(ray, hit);
    if (!(back >= 0 && back <= hit.distance_m / 2))
        return std::nullopt;
    return ray.origin + ray.direction * (hit.distance_m - back);
}

// Nothing is known of the other side. So the step over the surface is looked at: it must cross this one
// surface alone.
std::optional<glm::vec3> beyond_surface(const trace::Scene& scene,
                                        const trace::Ray& ray,
                                        const trace::Hit& hit) {
    const float step = clearance_along(ray, hit);
    const std::optional<glm::vec3> before = before_surface(ray, hit);
    if (!before || scene.crossings({*before, ray.direction, 2 * step}) != 1)
        return std::nullopt;
    return *before + ray.direction * (2 * step);
}

float end_of_surface(const trace::Ray& ray, const trace::Hit& hit) {
    return hit.distance_m + std::max(clearance_along(ray, hit), 0.0f);
}

// A back makes way for a front in its plane.
float end_of(const trace::Ray& ray, const std::optional<trace::Hit>& hit) {
    if (!hit)
        return ray.far_m;
    return hit->front ? hit->distance_m : end_of_surface(ray, *hit);
}

float exit_distance(const glm::vec3& origin,
                    const glm::vec3& direction,
                    const glm::vec3& centre,
                    float radius) {
    const glm::vec3 m = origin - centre;
    const float b = glm::dot(m, direction);
    const float c = glm::dot(m, m) - radius * radius;
    return c >= 0 ? 0 : -b + std::sqrt(b * b - c);
}

float transmitted_share(const trace::Surface& surface) {
    const float back = map::brightest(surface.albedo);
    const float through = map::brightest(surface.transmitted);
    return through > 0 ? through / (back + through) : 0;
}

std::optional<Scattered> scatter(const trace::Scene& scene,
                                 const trace::Ray& ray,
                                 const trace::Hit& hit,
                                 const trace::Surface& surface,
                                 glm::vec2 u) {
    const float share = transmitted_share(surface);
    const bool through = u.x < share;
    const std::optional<glm::vec3> origin =
        through ? beyond_surface(scene, ray, hit) : before_surface(ray, hit);
    if (!origin)
        return std::nullopt;
    Scattered scattered;
    scattered.origin = *origin;
    scattered.through = through;
    // The first number chose the side; what is left of it is uniform again.
    const float probability = through ? share : 1 - share;
    if (share > 0)
        u.x = std::min((through ? u.x : u.x - share) / probability, 1 - 0x1p-24f);
    const glm::vec3 normal = through ? -hit.normal : hit.normal;
    scattered.direction = cosine_hemisphere(u, normal);
    scattered.weight = (through ? surface.transmitted : surface.albedo) / probability;
    scattered.density =
        probability * std::max(glm::dot(scattered.direction, normal), 0.0f) * std::numbers::inv_pi_v<float>;
    return scattered;
}

}  // namespace drtv::bake
