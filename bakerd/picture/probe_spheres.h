// The probes of a set as spheres in the scene.
#pragma once

#include "bakerd/picture/camera.h"
#include "bakerd/picture/moment.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace drtv::picture {

class ProbeSpheres {
  public:
    ProbeSpheres(const Moment& moment, const Camera& camera);

    struct Met {
        float distance_m = 0;
        glm::vec3 radiance{};  // what a white sphere sends back of the probe's ambient light
    };
    // The first that the ray through a point of the picture meets.
    [[nodiscard]] std::optional<Met> first_on(const trace::Ray& ray, glm::vec2 pixel) const;

  private:
    struct Sphere {
        glm::vec3 centre{};
        float radius_m = 0;
        BasisColours colours{};
    };
    static constexpr std::size_t tile_pixels = 16;
    void add(const LoadedSector& sector, std::size_t probe, const Moment& moment, const Camera& camera);

    RelightMode mode_;
    std::size_t tiles_wide_;
    std::vector<Sphere> spheres_;
    std::vector<std::vector<std::uint32_t>> tiles_;  // of the picture: spheres that may show there
};

}  // namespace drtv::picture
