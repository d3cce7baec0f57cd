// Light of some moments, as the runtime takes it and as the reference does.
#pragma once

#include "tests/reference/reference_ambient.h"

#include <drtv/light.h>

#include <glm/vec3.hpp>

#include <vector>

namespace drtv::test {

struct TestMoment {
    SceneLight light;  // its mode is set by who asks
    reference::Moment truth;
};

// A sky of three colours and a sun; irradiance 3 pi of white is full daylight where the sky is about 1.
[[nodiscard]] TestMoment moment_of(const SkyColours& sky, const glm::dvec3& sun_irradiance,
                                   const glm::dvec3& to_sun);

// A day in twelve: the sun 10, 30 and 60 degrees high in four directions, and three skies in turn.
[[nodiscard]] std::vector<TestMoment> twelve_moments();

}  // namespace drtv::test
