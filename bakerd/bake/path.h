// How a path goes on from a surface: the steps that every integrator here shares.
#pragma once

#include "bakerd/bake/sampling.h"
#include "bakerd/trace/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>

namespace drtv::bake {

// Widths over which textures are averaged, radians of a ray's length: first rays of some 2,000 paths lie 1/13
// apart, the later ones of a path stand for a whole hemisphere.
inline constexpr float first_footprint = 1 / 16.0f, later_footprint = 1 / 4.0f;

// A point for further rays, certainly on the same side of every surface as the way that led to the hit;
// nothing where the way runs so close along the surface that there is none.
[[nodiscard]] std::optional<glm::vec3> before_surface(const trace::Ray& ray, const trace::Hit& hit);

// The same just beyond the surface that was hit; nothing where another surface lies within the step.
[[nodiscard]] std::optional<glm::vec3> beyond_surface(const trace::Scene& scene,
                                                      const trace::Ray& ray,
                                                      const trace::Hit& hit);

// How far along the ray that looks for other surfaces; and how far they lie that count as one with this one.
[[nodiscard]] float end_of_surface(const trace::Ray& ray, const trace::Hit& hit);

// Beyond this, metres along the ray, nothing matters for what it meets.
[[nodiscard]] float end_of(const trace::Ray& ray, const std::optional<trace::Hit>& hit);

// Where a ray leaves the sphere around `centre`; 0 when it starts outside.
[[nodiscard]] float exit_distance(const glm::vec3& origin,
                                  const glm::vec3& direction,
                                  const glm::vec3& centre,
                                  float radius);

struct Scattered {
    glm::vec3 origin;
    glm::vec3 direction;
    glm::vec3 weight;  // what radiance from `direction` counts
    float density;     // per steradian, of the direction
    bool through;      // to the other side of the surface
};

// The share of scattered light that is let through, as `scatter` draws it.
[[nodiscard]] float transmitted_share(const trace::Surface& surface);

// Draws reflection or transmission and a cosine-distributed direction; nothing where the path has to end.
[[nodiscard]] std::optional<Scattered> scatter(const trace::Scene& scene,
                                               const trace::Ray& ray,
                                               const trace::Hit& hit,
                                               const trace::Surface& surface,
                                               glm::vec2 u);

}  // namespace drtv::bake
