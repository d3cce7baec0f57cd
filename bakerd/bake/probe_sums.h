// What the paths of one probe have brought so far, and the light that follows from it. Upper and lower half
// of the first directions are normalised apart, each by the sum of its own basis cosines over the same
// samples: an open sky, a plane and the energy bound then hold exactly, whatever the samples.
#pragma once

#include "bakerd/bake/basis_sums.h"
#include "bakerd/bake/convergence.h"
#include "bakerd/bake/integrate.h"

#include <drtv/conventions.h>

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace drtv::bake {

// Half of the sphere of first directions, by the sign of z.
enum class Half : std::size_t { upper, lower };

class ProbeSums {
  public:
    // The paths that follow belong to that block of samples, [0, block_count).
    void choose_block(std::size_t block) { block_ = &blocks_[block]; }

    // Each block becomes the sum of two, in order; the upper half of them is empty then.
    void pair_blocks();

    // A first direction, whatever its path will bring.
    void add_direction(const BasisWeights& weights, Half half);
    // The sky, seen from the probe through glass that lets so much of its radiance through.
    void add_sky(const BasisWeights& weights, Half half, const glm::vec3& throughput);
    // The sky in a direction, seen by way of surfaces that let so much of its radiance through.
    void add_bounced_sky(const BasisWeights& weights,
                         Half half,
                         const glm::vec3& throughput,
                         const glm::vec3& direction);
    // Of E/pi relit by a sky of radiance 1: straight and by bounce together.
    [[nodiscard]] ErrorOfMean error() const;

    // REQUIRES: the transfer of `light` is zero.
    // Sets its transfer (the bounced sky) and visibility, and the errors of both.
    void store(ProbeLight& light) const;

  private:
    using Coefficients = std::array<std::array<std::array<double, sh_count>, basis_count>, channel_count>;

    // Enough for the relit irradiance of a block.
    struct Block {
        std::array<std::array<double, basis_count>, 2> weights{};  // [half]
        // Under a sky of radiance 1: straight from it, and [half] by bounce.
        BasisSums seen{};
        std::array<BasisSums, 2> bounced{};
        std::array<double, basis_count> visible{};

        void add(const Block& other);
    };

    // What `lit`, which gives the sum of a block for each half, makes of each block.
    template <class Lit>
    [[nodiscard]] ErrorOfMean error_of(Lit lit) const;

    std::array<Block, block_count> blocks_{};
    Block* block_ = nullptr;  // of the path at work
    std::array<Coefficients, 2> bounced_{};
};

}  // namespace drtv::bake
