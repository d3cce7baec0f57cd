// What the paths of one probe have brought so far, and the light that follows from it. Upper and lower half
// of the first directions are normalised apart, each by the sum of its own basis cosines over the same
// samples: an open sky, a plane and the energy bound then hold exactly, whatever the samples.
#pragma once

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

// The cosine between a direction and each basis direction, 0 where it is negative.
using BasisWeights = std::array<float, basis_count>;
[[nodiscard]] BasisWeights basis_weights(const glm::vec3& direction);

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
    // Static light of one path: E/pi in W/m2, times the number of paths.
    void add_static(const BasisWeights& weights, const glm::vec3& light);
    // Static light straight from a lamp to the probe, once for all paths.
    void add_direct(const BasisWeights& weights, const glm::vec3& light);

    // As IntegrationSettings::error has it.
    [[nodiscard]] double error(std::uint32_t paths, bool with_static_light) const;

    // REQUIRES: the transfer of `light` is zero, its paths are counted.
    // Sets its transfer (the bounced sky), visibility and static irradiance.
    void store(ProbeLight& light) const;

  private:
    using Coefficients = std::array<std::array<std::array<double, sh_count>, basis_count>, channel_count>;
    using BasisSums = std::array<std::array<double, basis_count>, channel_count>;

    // Enough for the relit irradiance of a block.
    struct Block {
        std::array<std::array<double, basis_count>, 2> weights{};  // [half]
        std::array<BasisSums, 2> lit{};                            // [half], under a sky of radiance 1
        BasisSums static_light{};

        void add(const Block& other);
    };

    static void add(BasisSums& sums, const BasisWeights& weights, const glm::vec3& light);
    static void add(BasisSums& sums, const BasisSums& more);

    std::array<Block, block_count> blocks_{};
    Block* block_ = nullptr;  // of the path at work
    std::array<Coefficients, 2> bounced_{};
    std::array<double, basis_count> visible_{};
    BasisSums direct_{};
};

}  // namespace drtv::bake
