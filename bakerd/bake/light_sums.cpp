#include "bakerd/bake/light_sums.h"

#include <algorithm>

namespace drtv::bake {

void LightSums::pair_blocks() {
    bake::pair_blocks(blocks_, [](BasisSums& sum, const BasisSums& more) { bake::add(sum, more); });
}

void LightSums::add(const BasisWeights& weights, const glm::vec3& light) {
    bake::add(blocks_[block_], weights, light);
}

void LightSums::add_direct(const BasisWeights& weights, const glm::vec3& light) {
    bake::add(direct_, weights, light);
}

ErrorOfMean LightSums::error(std::uint32_t paths) const {
    BlockMeans<channel_count * basis_count> lit{};
    const double paths_of_block = static_cast<double>(paths) / block_count;
    for (std::size_t k = 0; k < block_count; ++k) {
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t b = 0; b < basis_count; ++b)
                lit[k][c * basis_count + b] = blocks_[k][c][b] / paths_of_block;
        }
    }
    return error_of_mean(lit);
}

StaticLightOfProbe LightSums::light_of(std::uint32_t paths) const {
    StaticLightOfProbe light;
    BasisSums scattered{};
    for (const BasisSums& block : blocks_)
        bake::add(scattered, block);
    double direct = 0;
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b) {
            light.irradiance[c][b] = static_cast<float>(direct_[c][b] + scattered[c][b] / paths);
            direct += direct_[c][b] / (channel_count * basis_count);
        }
    }
    const ErrorOfMean found = error(paths);
    // One path more or less that finds a faint light, and none of those there are may have: blocks of nothing
    // agree with each other.
    constexpr double mean_weight = 0.25;  // of a direction, for one side
    const double least = mean_weight * static_cast<double>(faint_light) / paths;
    const double off = std::max(found.error, least);
    light.error = static_cast<float>(off / std::max(found.mean + direct, off));
    return light;
}

}  // namespace drtv::bake
