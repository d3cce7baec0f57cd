// Sums over paths by basis direction, as integrators keep them.
#pragma once

#include <drtv/conventions.h>

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>

namespace drtv::bake {

// The cosine between a direction and each basis direction, 0 where it is negative.
using BasisWeights = std::array<float, basis_count>;
[[nodiscard]] BasisWeights basis_weights(const glm::vec3& direction);

using BasisSums = std::array<std::array<double, basis_count>, channel_count>;  // [channel][basis direction]

void add(BasisSums& sums, const BasisWeights& weights, const glm::vec3& light);
void add(BasisSums& sums, const BasisSums& more);

}  // namespace drtv::bake
