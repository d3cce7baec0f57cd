// What the paths of one probe have brought of the static light of one set of lights.
#pragma once

#include "bakerd/bake/basis_sums.h"
#include "bakerd/bake/convergence.h"
#include "bakerd/bake/integrate.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace drtv::bake {

class LightSums {
  public:
    // As ProbeSums has them.
    void choose_block(std::size_t block) { block_ = block; }
    void pair_blocks();

    // Of one path: E/pi in W/m2, times the number of paths.
    void add(const BasisWeights& weights, const glm::vec3& light);
    // Straight from a lamp to the probe, once for all paths.
    void add_direct(const BasisWeights& weights, const glm::vec3& light);

    // Of what paths bring, without the direct light.
    [[nodiscard]] ErrorOfMean error(std::uint32_t paths) const;

    [[nodiscard]] StaticLightOfProbe light_of(std::uint32_t paths) const;

  private:
    std::array<BasisSums, block_count> blocks_{};
    std::size_t block_ = 0;  // of the path at work
    BasisSums direct_{};
};

}  // namespace drtv::bake
