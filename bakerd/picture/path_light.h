// The ambient light of a place by path tracing: what the runtime's is held against.
#pragma once

#include "bakerd/bake/sampling.h"
#include "bakerd/picture/path_walk.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

namespace drtv::picture {

using PathBasis = std::array<PathParts, basis_count>;
// As a probe would show it: of truth, nothing is below 0.
[[nodiscard]] BasisColours colours_of(const PathBasis& basis, Show show);

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
    PathScene scene_;
};

}  // namespace drtv::picture
