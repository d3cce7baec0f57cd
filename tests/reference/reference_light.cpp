#include "tests/reference/reference_light.h"

#include "tests/reference/reference_scene.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace drtv::reference {
namespace {

constexpr double min_distance_m = 0.01;
constexpr double min_local_distance2_m2 = 0.25;

// "Range property" of the extension, without the division by the squared distance.
double range_share(double distance_m, double range_m) {
    if (range_m <= 0)
        return 1;
    return std::max(std::min(1 - std::pow(distance_m / range_m, 4), 1.0), 0.0);
}

// "Inner and outer cone angles" of the extension.
double cone_share(const map::Light& light, const glm::dvec3& towards) {
    const double cos_inner = std::cos(static_cast<double>(light.inner_cone_radians)),
                 cos_outer = std::cos(static_cast<double>(light.outer_cone_radians));
    const double scale = 1 / std::max(0.001, cos_inner - cos_outer), offset = -cos_outer * scale;
    const double cd = -glm::dot(glm::normalize(glm::dvec3(light.direction)), towards);
    const double share = std::clamp(cd * scale + offset, 0.0, 1.0);
    return share * share;
}

}  // namespace

std::optional<Incidence> incidence(const map::Light& light, const glm::dvec3& point) {
    Incidence result;
    result.irradiance = glm::dvec3(light.colour) * static_cast<double>(light.intensity) / lumens_per_watt;
    if (light.kind == map::LightKind::directional) {
        result.towards = -glm::normalize(glm::dvec3(light.direction));
        result.distance_m = std::numeric_limits<double>::infinity();
    } else {
        const glm::dvec3 way = glm::dvec3(light.position) - point;
        result.distance_m = glm::length(way);
        if (!(result.distance_m > 0))
            return std::nullopt;
        result.towards = way / result.distance_m;
        result.irradiance *= range_share(result.distance_m, static_cast<double>(light.range_m)) /
                             std::pow(std::max(result.distance_m, min_distance_m), 2);
        if (light.kind == map::LightKind::spot)
            result.irradiance *= cone_share(light, result.towards);
    }
    if (result.irradiance == glm::dvec3(0))
        return std::nullopt;
    return result;
}

std::optional<Incidence> local_incidence(const glm::dvec3& source, const glm::dvec3& point) {
    const glm::dvec3 way = source - point;
    const double distance = glm::length(way);
    if (!(distance > 0))
        return std::nullopt;
    return Incidence{way / distance, distance,
                     glm::dvec3(1 / std::max(distance * distance, min_local_distance2_m2))};
}

}  // namespace drtv::reference
