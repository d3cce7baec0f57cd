#include "tests/ambient/moments.h"

#include "tests/ambient/vectors.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <numbers>

namespace drtv::test {
TestMoment moment_of(const SkyColours& sky, const glm::dvec3& sun_irradiance, const glm::dvec3& to_sun) {
    const glm::dvec3 unit = glm::normalize(to_sun);
    TestMoment moment;
    moment.light.sky = gradient_sky(sky, as_float(unit));
    moment.light.sun = {as_float(sun_irradiance), as_float(unit)};
    // The formula of drtv/light.h, worked out here again.
    const glm::dvec2 across(unit.x, unit.y);
    const double length = glm::length(across);
    const glm::dvec2 side = length > 0 ? across / length : glm::dvec2(0);
    moment.truth.sky = [=, zenith = as_double(sky.zenith), horizon = as_double(sky.horizon),
                        sun_side = as_double(sky.sun_side)](const glm::dvec3& w) {
        return horizon + (zenith - horizon) * w.z + sun_side * ((1 + w.x * side.x + w.y * side.y) / 2);
    };
    moment.truth.sun_irradiance = unit.z > 0 ? sun_irradiance : glm::dvec3(0);
    moment.truth.to_sun = unit;
    return moment;
}

std::vector<TestMoment> twelve_moments() {
    constexpr std::array<SkyColours, 3> skies = {{
        {.zenith = {1, 1, 1}, .horizon = {1, 1, 1}},                                        // overcast
        {.zenith = {0.5f, 0.8f, 1.5f}, .horizon = {1, 1, 1}, .sun_side = {0.2f, 0.1f, 0}},  // clear
        {.zenith = {0.4f, 0.5f, 0.8f}, .horizon = {0.8f, 0.7f, 0.7f}, .sun_side = {1.2f, 0.6f, 0.2f}},
    }};
    std::vector<TestMoment> moments;
    for (const double elevation_deg : {10.0, 30.0, 60.0}) {
        for (const double azimuth_deg : {20.0, 110.0, 200.0, 290.0}) {
            constexpr double radians = std::numbers::pi / 180;
            const double up = elevation_deg * radians;
            const double around = azimuth_deg * radians;
            moments.push_back(
                moment_of(skies[moments.size() % skies.size()], glm::dvec3(3 * std::numbers::pi),
                          {std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up)}));
        }
    }
    return moments;
}

}  // namespace drtv::test
