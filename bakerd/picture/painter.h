// The colour of a point of a picture.
#pragma once

#include "bakerd/picture/camera.h"
#include "bakerd/picture/moment.h"
#include "bakerd/picture/probe_spheres.h"
#include "bakerd/picture/scenery.h"
#include "bakerd/picture/show.h"
#include "bakerd/picture/surface_point.h"
#include "bakerd/picture/texel_age.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>

namespace drtv::picture {

// Of the ambient light what is shown: all, or a part.
[[nodiscard]] glm::vec3 part_of(const Ambient& ambient, Show show);

// What a surface sends back besides the ambient light: sun, lamps, and what it shines itself.
[[nodiscard]] glm::vec3 direct_light(const Scenery& scenery, const Moment& moment, const SurfacePoint& point);

// What a ray that meets nothing shows: the sky, in the colour of clear glass on the way.
[[nodiscard]] glm::vec3 sky_seen(const Scenery& scenery,
                                 const Moment& moment,
                                 const trace::Ray& ray,
                                 bool with_sun);

// All arguments must outlive it. Thread-safe. REQUIRES of the callers: a FloatMode.
class Painter {
  public:
    Painter(const Scenery& scenery, const Moment& moment, const Camera& camera, Show show);

    // Radiance where is_light(show), else a linear colour of 0 to 1.
    [[nodiscard]] glm::vec3 colour(glm::vec2 pixel) const;
    [[nodiscard]] bool is_light() const { return picture::is_light(show_); }

    [[nodiscard]] bool shows_all() const { return show_ == Show::all; }
    // How much of its light a surface shows.
    [[nodiscard]] float brightness_of(const SurfacePoint& point) const;

    void use_age(const TexelAge& age) { age_ = &age; }

  private:
    [[nodiscard]] glm::vec3 whole(const SurfacePoint& point) const;
    [[nodiscard]] glm::vec3 with_spheres(const trace::Ray& ray,
                                         const std::optional<SurfacePoint>& point,
                                         glm::vec2 pixel) const;
    [[nodiscard]] glm::vec3 of_runtime(const SurfacePoint& point) const;
    [[nodiscard]] glm::vec3 fallback(const SurfacePoint& point) const;
    [[nodiscard]] glm::vec3 leaks(const SurfacePoint& point) const;
    [[nodiscard]] glm::vec3 clipped(const SurfacePoint& point) const;

    const Scenery& scenery_;
    const Moment& moment_;
    const Camera& camera_;
    const Show show_;
    std::optional<ProbeSpheres> spheres_;
    const TexelAge* age_ = nullptr;
};

}  // namespace drtv::picture
