#include "bakerd/bake/basis_sums.h"

#include <algorithm>

namespace drtv::bake {

BasisWeights basis_weights(const glm::vec3& direction) {
    BasisWeights weights{};
    for (std::size_t b = 0; b < basis_count; ++b) {
        const auto& axis = transfer_basis[b];
        const float cosine = direction.x * axis[0] + direction.y * axis[1] + direction.z * axis[2];
        weights[b] = std::max(0.0f, cosine);
    }
    return weights;
}

void add(BasisSums& sums, const BasisWeights& weights, const glm::vec3& light) {
    for (std::size_t c = 0; c < channel_count; ++c) {
        const float colour = light[static_cast<glm::length_t>(c)];
        for (std::size_t b = 0; b < basis_count; ++b)
            sums[c][b] += static_cast<double>(weights[b] * colour);
    }
}

void add(BasisSums& sums, const BasisSums& more) {
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b)
            sums[c][b] += more[c][b];
    }
}

}  // namespace drtv::bake
