// Ambient light at a point by brute force: what the runtime's whole way, from baked files to a shaded normal,
// is held against. Paths from the point, uniform directions, double precision.
#pragma once

#include "tests/reference/reference_scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace drtv::reference {

struct GameLamp {
    glm::dvec3 position{};
    glm::dvec3 intensity{};  // W/sr
};

// All light but the map's own.
struct Moment {
    std::function<glm::dvec3(const glm::dvec3&)> sky;  // radiance from a unit direction above the horizon
    glm::dvec3 sun_irradiance{};                       // on a surface that faces it
    glm::dvec3 to_sun{0, 0, 1};                        // unit
    std::vector<GameLamp> lamps;
};

// E/pi at one normal. Of the sun and of the game's lamps it is what surfaces send back; of the map's own
// lights all.
struct AmbientLight {
    glm::dvec3 sky_direct{};
    glm::dvec3 sky_bounce{};
    glm::dvec3 sun_bounce{};
    glm::dvec3 static_light{};
    glm::dvec3 local{};

    [[nodiscard]] glm::dvec3 total() const {
        return sky_direct + sky_bounce + sun_bounce + static_light + local;
    }
};

struct AmbientOptions {
    std::uint32_t bounces = 3;
    std::uint32_t local_bounces = 2;  // of the game's lamps
    double reach_m = 512;             // farther from the point is sky
    std::uint32_t strata = 64;        // strata^2 paths
    std::uint64_t seed = 1;
};

// [moment][normal], from the same paths. REQUIRES: unit normals.
[[nodiscard]] std::vector<std::vector<AmbientLight>> ambient(const Scene& scene, const glm::dvec3& point,
                                                             std::span<const glm::dvec3> normals,
                                                             std::span<const Moment> moments,
                                                             const AmbientOptions& options);

}  // namespace drtv::reference
