// What the paths of one probe have brought of the static light of one set of lights.
#pragma once

#include "bakerd/bake/basis_sums.h"
#include "bakerd/bake/convergence.h"
#include "bakerd/bake/integrate.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace drtv::bake {

// What adds less than this to a path's static light, W/m2, is looked at only so often, and then counts as
// this much: in the mean of some 1,000 paths it does not show. So lamps far away cost nothing.
inline constexpr float faint_light = 0.01f;

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
