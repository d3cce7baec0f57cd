// KHR_lights_punctual as its text gives the formulas, in W.
#pragma once

#include "bakerd/map/map.h"

#include <glm/vec3.hpp>

#include <optional>

namespace drtv::reference {

// Light from one direction at a point.
struct Incidence {
    glm::dvec3 towards{};     // unit, to the light
    double distance_m = 0;    // infinite for a directional light
    glm::dvec3 irradiance{};  // W/m2 on a surface that faces the light
};

// Nothing where the light sends nothing, whatever stands in between.
[[nodiscard]] std::optional<Incidence> incidence(const map::Light& light, const glm::dvec3& point);

// A white light of 1 W/sr as local transfer has them: nearer than half a metre it gets no brighter.
[[nodiscard]] std::optional<Incidence> local_incidence(const glm::dvec3& source, const glm::dvec3& point);

}  // namespace drtv::reference
