// Steps that all of the reference's integrals are made of: rays within reach of a probe, light that a surface
// scatters, the next direction, and means with their errors.
#pragma once

#include "tests/reference/reference_light.h"
#include "tests/reference/reference_random.h"
#include "tests/reference/reference_scene.h"

#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace drtv::reference {

// Uniform on the sphere for u and v in [0, 1).
[[nodiscard]] glm::dvec3 sphere_direction(double u, double v);

// One probe's surroundings: what lies within a sphere around it, at every bounce.
struct Walk {
    const Scene& scene;
    glm::dvec3 probe{};
    double reach_m = 0;
    Random random;

    // A hit outside the sphere of reach is none; beyond it there is nothing to come back from.
    // `tint` is multiplied with the colour of glass on the way.
    [[nodiscard]] std::optional<SurfaceHit> closest(const glm::dvec3& origin, const glm::dvec3& direction,
                                                    glm::dvec3& tint);

    // The share of the light that reaches the point (once; blended surfaces draw).
    [[nodiscard]] glm::dvec3 lit(const glm::dvec3& point, const Incidence& light);

    // Whether a light at `position` counts for this probe.
    [[nodiscard]] bool within_reach(const glm::dvec3& position) const;

    // Those of the map that count for this probe.
    [[nodiscard]] std::vector<const map::Light*> lights() const;

    // Radiance that the surface at `point` scatters of the light to the side of its normal.
    [[nodiscard]] glm::dvec3 scattered(const SurfaceHit& hit, const glm::dvec3& point,
                                       const Incidence& light);

    struct Step {
        glm::dvec3 origin{}, direction{};
        glm::dvec3 weight{};  // of the radiance that comes from there
    };
    // A direction from which the surface takes light, uniform over the hemisphere, or the sphere where it
    // transmits.
    [[nodiscard]] static Step onward(const SurfaceHit& hit, const glm::dvec3& point, double u, double v);
};

// Mean and standard error from sums over batches.
struct Spread {
    double sum = 0, squares = 0;
    void add(double v) { sum += v, squares += v * v; }
    [[nodiscard]] double mean(double n) const { return sum / n; }
    [[nodiscard]] double error(double n) const {
        return std::sqrt(std::max(0.0, squares / n - mean(n) * mean(n)) / (n - 1));
    }
};

}  // namespace drtv::reference
