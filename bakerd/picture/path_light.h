// The ambient light of a place by path tracing: what the runtime's is held against.
#pragma once

#include "bakerd/bake/next_event.h"
#include "bakerd/bake/path.h"
#include "bakerd/bake/sampling.h"
#include "bakerd/picture/moment.h"
#include "bakerd/picture/scenery.h"
#include "bakerd/picture/show.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace drtv::picture {

struct PathSettings {
    std::uint32_t bounces = 3;
    std::uint32_t local_bounces = 2;  // of the game's lamps
    float reach_m = 512;              // farther from the place is sky
};

// E/pi by part, as drtv::AmbientParts has it; of sun and lamps, what surfaces send back.
struct PathParts {
    glm::vec3 sky_direct{};
    glm::vec3 sky_bounce{};
    glm::vec3 sun_bounce{};
    glm::vec3 static_light{};
    glm::vec3 local{};

    [[nodiscard]] glm::vec3 total() const {
        return sky_direct + sky_bounce + sun_bounce + static_light + local;
    }
    void add(const PathParts& parts, const glm::vec3& weight);
};
// As part_of an Ambient (painter.h).
[[nodiscard]] glm::vec3 part_of(const PathParts& truth, Show show);

using PathBasis = std::array<PathParts, basis_count>;

// Thread-safe. REQUIRES of all calls: a FloatMode. What is passed in must outlive it.
class PathLight {
  public:
    PathLight(const Scenery& scenery, const Moment& moment, const PathSettings& settings);

    // At a unit normal, by so many paths; another seed, another noise. `place` must be free.
    [[nodiscard]] PathParts at_normal(const glm::vec3& place,
                                      const glm::vec3& normal,
                                      const bake::SampleTable& paths,
                                      const glm::ivec3& seed) const;
    // At the four directions of the transfer basis.
    [[nodiscard]] PathBasis at_basis(const glm::vec3& place,
                                     const bake::SampleTable& paths,
                                     const glm::ivec3& seed) const;

    // Numbers a path that a table should have.
    [[nodiscard]] std::uint32_t dimensions() const;

  private:
    class Walk;

    const Scenery& scenery_;
    const Moment& moment_;
    const PathSettings settings_;
    std::vector<glm::vec3> factors_;  // of the map's sets of lights
};

}  // namespace drtv::picture
