#include "tests/reference/reference_walk.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <numbers>

namespace drtv::reference {
namespace {

using std::numbers::pi;

// Far over double's rounding at 100 km, far under anything modelled.
constexpr double surface_offset_m = 1e-7;

}  // namespace

glm::dvec3 sphere_direction(double u, double v) {
    const double z = 1 - 2 * u, r = std::sqrt(std::max(0.0, 1 - z * z)), angle = 2 * pi * v;
    return {r * std::cos(angle), r * std::sin(angle), z};
}

std::optional<SurfaceHit> Walk::closest(const glm::dvec3& origin, const glm::dvec3& direction,
                                        glm::dvec3& tint) {
    auto hit = scene.closest(origin, direction, random, tint);
    if (hit && glm::length(origin + hit->distance_m * direction - probe) > reach_m)
        hit.reset();
    return hit;
}

bool Walk::within_reach(const glm::dvec3& position) const {
    return glm::length(position - probe) <= reach_m;
}

std::vector<const map::Light*> Walk::lights() const {
    std::vector<const map::Light*> lights;
    for (const map::Light& light : scene.lights()) {
        if (light.kind == map::LightKind::directional || within_reach(glm::dvec3(light.position)))
            lights.push_back(&light);
    }
    return lights;
}

glm::dvec3 Walk::lit(const glm::dvec3& point, const Incidence& light) {
    // Where the way to a directional light leaves the sphere of reach; `point` lies in it.
    const glm::dvec3 from_probe = point - probe;
    const double middle = glm::dot(from_probe, light.towards);
    const double leaves =
        -middle +
        std::sqrt(std::max(0.0, middle * middle + reach_m * reach_m - glm::dot(from_probe, from_probe)));
    return scene.arriving(point, light.towards, std::min(leaves, light.distance_m), random);
}

glm::dvec3 Walk::scattered(const SurfaceHit& hit, const glm::dvec3& point, const Incidence& light) {
    const double cosine = glm::dot(hit.normal, light.towards);
    const glm::dvec3& share = cosine > 0 ? hit.reflected : hit.transmitted;
    if (cosine == 0 || share == glm::dvec3(0))
        return glm::dvec3(0);
    const glm::dvec3 seen = lit(point + std::copysign(surface_offset_m, cosine) * hit.normal, light);
    return share / pi * std::abs(cosine) * light.irradiance * seen;
}

Walk::Step Walk::onward(const SurfaceHit& hit, const glm::dvec3& point, double u, double v) {
    const bool transmits = hit.transmitted != glm::dvec3(0);
    const glm::dvec3 local = sphere_direction(transmits ? u : u / 2, v);
    const glm::dvec3 aside = std::abs(hit.normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 tangent = glm::normalize(glm::cross(aside, hit.normal));
    Step step;
    step.direction = local.x * tangent + local.y * glm::cross(hit.normal, tangent) + local.z * hit.normal;
    step.origin = point + std::copysign(surface_offset_m, local.z) * hit.normal;
    // Lambert: share / pi, times the cosine, over the density: 1 / (2 pi) of the hemisphere, 1 / (4 pi) of
    // the sphere.
    step.weight = (local.z > 0 ? hit.reflected : hit.transmitted) * (std::abs(local.z) * (transmits ? 4 : 2));
    return step;
}

}  // namespace drtv::reference
