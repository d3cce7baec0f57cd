// What a ray from a camera meets, and the light that comes straight to it.
#pragma once

#include "bakerd/picture/camera.h"
#include "bakerd/picture/incidence.h"
#include "bakerd/trace/scene.h"

#include <drtv/local_lights.h>

#include <glm/vec3.hpp>

#include <optional>

namespace drtv::picture {

struct SurfacePoint {
    trace::Ray ray;
    trace::Hit hit;
    trace::Surface surface;
    glm::vec3 at{};
    glm::vec3 tint{1};  // of clear glass on the way
};

// Nothing where the ray meets nothing. Textures are averaged over a pixel.
[[nodiscard]] std::optional<SurfacePoint> surface_on(const trace::Scene& scene,
                                                     const Camera& camera,
                                                     const trace::Ray& ray);

[[nodiscard]] Incidence incidence(const PointLight& lamp, const glm::vec3& at);

// What the surface sends back of it towards the ray's origin, where nothing hides the light.
[[nodiscard]] glm::vec3 scattered(const trace::Scene& scene,
                                  const SurfacePoint& point,
                                  const Incidence& light);

}  // namespace drtv::picture
