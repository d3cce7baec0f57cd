#include "bakerd/bake/static_light.h"

#include "bakerd/bake/path.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace drtv::bake {
namespace {

constexpr float inv_pi = std::numbers::inv_pi_v<float>;

// The probability per steradian with which a path would go on from the surface in a direction of that cosine
// to the normal, on that side.
float scattering_density(const trace::Surface& surface, float cosine, bool through) {
    const float through_share = transmitted_share(surface);
    const float side_share = through ? through_share : 1 - through_share;
    return side_share * std::abs(cosine) * inv_pi;
}

}  // namespace

// The first directions' density cancels with the weights' own, which all sums share: they count radiance
// times cosine times 4.
void StaticLight::add_met(const Path& path, const trace::Hit& hit, const glm::vec3& emission) {
    const float drawn = next_event_.density_of(path.ray.origin, path.ray.direction, hit);
    const float watts = 4 * path.density / (lumens_per_watt * (path.density + drawn));
    sums_.add(path.weights, path.throughput * emission * watts);
}

void StaticLight::add_drawn_at_probe(std::uint32_t path_number) {
    if (!next_event_.has_emissive())
        return;
    const std::optional<Incident> incident =
        next_event_.draw(task_.probe, light_sample(path_number, 0), {0, 0});
    if (!incident || incident->density <= 0)
        return;
    const float heuristic = incident->density / (incident->density + uniform_density);
    glm::vec3 light = incident->light * (heuristic * inv_pi);
    const float paths = static_cast<float>(task_.samples.count());
    if (!survives(light, path_number, 0))
        return;
    const BasisWeights weights = basis_weights(incident->direction);
    const glm::vec3 seen = share_seen(task_.probe, *incident, weights, light / paths);
    if (seen != glm::vec3(0))
        sums_.add(weights, light * seen);
}

void StaticLight::add_at_surface(const Path& path, const trace::Hit& hit, const trace::Surface& surface) {
    const glm::vec3 point = path.ray.origin + path.ray.direction * hit.distance_m;
    for (const StaticSun* sun : next_event_.suns())
        add_incident(path, hit, surface, next_event_.towards(*sun, point));
    if (!next_event_.has_drawn_lights())
        return;
    const std::uint32_t k = path.bounce + 1;
    const float max_share =
        brightest(path.throughput * (surface.albedo + surface.transmitted)) * (4 * inv_pi);
    const Roulette roulette{rounded_unit_float(hashed(task_.shift[1], path.number, 2 * k)),
                            faint_light / max_share};
    const std::optional<Incident> incident = next_event_.draw(point, light_sample(path.number, k), roulette);
    if (incident)
        add_incident(path, hit, surface, *incident);
}

void StaticLight::add_incident(const Path& path,
                               const trace::Hit& hit,
                               const trace::Surface& surface,
                               const Incident& incident) {
    const float cosine = glm::dot(incident.direction, hit.normal);
    const bool through = cosine < 0;
    const glm::vec3& scattered = through ? surface.transmitted : surface.albedo;
    glm::vec3 light = path.throughput * scattered * incident.light * (std::abs(cosine) * 4 * inv_pi);
    if (!survives(light, path.number, 2 * (path.bounce + 1) + 1))
        return;
    const std::optional<glm::vec3> start =
        through ? beyond_surface(task_.scene, path.ray, hit) : before_surface(path.ray, hit);
    const float paths = static_cast<float>(task_.samples.count());
    if (!start)
        return;
    const glm::vec3 seen = share_seen(*start, incident, path.weights, light / paths);
    if (seen == glm::vec3(0))
        return;
    light *= seen;
    if (incident.density > 0)
        light *= incident.density / (incident.density + scattering_density(surface, cosine, through));
    sums_.add(path.weights, light);
}

void StaticLight::add_direct() {
    const auto add = [&](const Incident& incident) {
        const BasisWeights weights = basis_weights(incident.direction);
        const glm::vec3 light = incident.light * inv_pi;
        if (incident.light == glm::vec3(0))
            return;
        const trace::Ray ray = shadow_ray(task_.probe, incident, weights, light);
        const glm::vec3 seen = task_.scene.share_seen(ray, incident.target.has_value());
        if (seen != glm::vec3(0))
            sums_.add_direct(weights, light * seen);
    };
    for (const StaticSun* sun : next_event_.suns())
        add(next_event_.towards(*sun, task_.probe));
    for (const StaticPointLight* light : next_event_.points())
        add(next_event_.towards(*light, task_.probe));
}

// Numbers that draw a light at a path's k-th point: of the table as far as it goes, else hashed.
std::array<double, numbers_per_light> StaticLight::light_sample(std::uint32_t path_number,
                                                                std::uint32_t point) const {
    std::array<double, numbers_per_light> u{};
    const std::span<const std::uint32_t> table = task_.samples.point(path_number);
    const std::uint32_t first = 2 + 2 * task_.settings.bounces + numbers_per_light * point;
    for (std::uint32_t d = 0; d < numbers_per_light; ++d) {
        const std::uint32_t dimension = first + d;
        const std::uint32_t word = dimension < table.size() ? table[dimension] ^ task_.shift[dimension]
                                                            : hashed(task_.shift[0], path_number, dimension);
        u[d] = static_cast<double>(word) * 0x1p-32;
    }
    return u;
}

// Russian roulette: faint light is dropped, or raised by as much as it is seldom kept.
bool StaticLight::survives(glm::vec3& light, std::uint32_t path_number, std::uint32_t draw) const {
    const float most = brightest(light);
    if (most >= faint_light)
        return true;
    if (rounded_unit_float(hashed(task_.shift[1], path_number, draw)) * faint_light >= most)
        return false;
    light *= faint_light / most;
    return true;
}

glm::vec3 StaticLight::share_seen(const glm::vec3& start,
                                  const Incident& incident,
                                  const BasisWeights& weights,
                                  const glm::vec3& light) {
    const trace::Ray ray = shadow_ray(start, incident, weights, light);
    const bool hidden = incident.target ? task_.scene.hides_surface(ray) : task_.scene.occluded(ray);
    if (hidden)
        return glm::vec3(0);
    return task_.scene.passed(ray, incident.target.has_value()).tint;
}

trace::Ray StaticLight::shadow_ray(const glm::vec3& start,
                                   const Incident& incident,
                                   const BasisWeights& weights,
                                   const glm::vec3& light) {
    ++shadow_rays_;
    const trace::Ray ray = NextEvent::shadow_ray(start, incident);
    if (task_.watch != nullptr) {
        const ShadowRay watched{ray, shares_of(weights, brightest(light) / static_irradiance_range)};
        task_.watch->record_shadow_rays({&watched, 1});
    }
    return ray;
}

}  // namespace drtv::bake
