#include "bakerd/bake/probe_sums.h"

#include "bakerd/map/colour.h"

#include <algorithm>

namespace drtv::bake {
namespace {

constexpr std::size_t upper = static_cast<std::size_t>(Half::upper);
constexpr std::size_t lower = static_cast<std::size_t>(Half::lower);

// The share of a cosine lobe around the basis direction that lies above the horizon, and below.
std::array<double, 2> lobe_shares(std::size_t b) {
    const double above = (1 + static_cast<double>(transfer_basis[b][2])) / 2;
    return {above, 1 - above};
}

}  // namespace

BasisWeights basis_weights(const glm::vec3& direction) {
    BasisWeights weights{};
    for (std::size_t b = 0; b < basis_count; ++b) {
        const auto& axis = transfer_basis[b];
        const float cosine = direction.x * axis[0] + direction.y * axis[1] + direction.z * axis[2];
        weights[b] = std::max(0.0f, cosine);
    }
    return weights;
}

void ProbeSums::add(BasisSums& sums, const BasisWeights& weights, const glm::vec3& light) {
    for (std::size_t c = 0; c < channel_count; ++c) {
        const float colour = light[static_cast<glm::length_t>(c)];
        for (std::size_t b = 0; b < basis_count; ++b)
            sums[c][b] += static_cast<double>(weights[b] * colour);
    }
}

void ProbeSums::add(BasisSums& sums, const BasisSums& more) {
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b)
            sums[c][b] += more[c][b];
    }
}

void ProbeSums::Block::add(const Block& other) {
    for (const std::size_t half : {upper, lower}) {
        for (std::size_t b = 0; b < basis_count; ++b)
            weights[half][b] += other.weights[half][b];
        ProbeSums::add(lit[half], other.lit[half]);
    }
    ProbeSums::add(static_light, other.static_light);
}

void ProbeSums::pair_blocks() {
    for (std::size_t k = 0; k < block_count / 2; ++k) {
        Block pair = blocks_[2 * k];
        pair.add(blocks_[2 * k + 1]);
        blocks_[k] = pair;
    }
    std::fill(blocks_.begin() + block_count / 2, blocks_.end(), Block{});
}

void ProbeSums::add_direction(const BasisWeights& weights, Half half) {
    auto& sums = block_->weights[static_cast<std::size_t>(half)];
    for (std::size_t b = 0; b < basis_count; ++b)
        sums[b] += static_cast<double>(weights[b]);
}

void ProbeSums::add_sky(const BasisWeights& weights, Half half, const glm::vec3& throughput) {
    if (half == Half::lower)
        return;
    const float share = throughput == glm::vec3(1) ? 1 : map::luminance(throughput);
    for (std::size_t b = 0; b < basis_count; ++b)
        visible_[b] += static_cast<double>(weights[b] * share);
    add(block_->lit[upper], weights, throughput);
}

void ProbeSums::add_bounced_sky(const BasisWeights& weights,
                                Half half,
                                const glm::vec3& throughput,
                                const glm::vec3& direction) {
    const Float4 y = evaluate_sh({direction.x, direction.y, direction.z});
    const auto h = static_cast<std::size_t>(half);
    for (std::size_t c = 0; c < channel_count; ++c) {
        const float colour = throughput[static_cast<glm::length_t>(c)];
        for (std::size_t b = 0; b < basis_count; ++b) {
            const double radiance = static_cast<double>(weights[b] * colour);
            for (std::size_t i = 0; i < sh_count; ++i)
                bounced_[h][c][b][i] += radiance * static_cast<double>(y[i]);
        }
    }
    add(block_->lit[h], weights, throughput);
}

void ProbeSums::add_static(const BasisWeights& weights, const glm::vec3& light) {
    add(block_->static_light, weights, light);
}

void ProbeSums::add_direct(const BasisWeights& weights, const glm::vec3& light) {
    add(direct_, weights, light);
}

double ProbeSums::error(std::uint32_t paths, bool with_static_light) const {
    BlockMeans relit{};
    BlockMeans lit{};
    const double paths_of_block = static_cast<double>(paths) / block_count;
    for (std::size_t k = 0; k < block_count; ++k) {
        const Block& block = blocks_[k];
        for (std::size_t b = 0; b < basis_count; ++b) {
            const std::array<double, 2> share = lobe_shares(b);
            for (std::size_t c = 0; c < channel_count; ++c) {
                for (const std::size_t half : {upper, lower}) {
                    const double weight = block.weights[half][b];
                    if (weight > 0)
                        relit[k][c][b] += share[half] * block.lit[half][c][b] / weight;
                }
                lit[k][c][b] = block.static_light[c][b] / paths_of_block;
            }
        }
    }
    const double error = relative_error(relit);
    return with_static_light ? std::max(error, relative_error(lit)) : error;
}

void ProbeSums::store(ProbeLight& light) const {
    Block all;
    for (const Block& block : blocks_)
        all.add(block);
    for (std::size_t b = 0; b < basis_count; ++b) {
        const std::array<double, 2> share = lobe_shares(b);
        for (const std::size_t half : {upper, lower}) {
            if (all.weights[half][b] <= 0)
                continue;
            const double scale = share[half] / all.weights[half][b];
            for (std::size_t c = 0; c < channel_count; ++c) {
                for (std::size_t i = 0; i < sh_count; ++i)
                    light.transfer[c][b][i] += static_cast<float>(bounced_[half][c][b][i] * scale);
            }
        }
        if (all.weights[upper][b] > 0)
            light.sky_visibility[b] = static_cast<float>(visible_[b] / all.weights[upper][b]);
        for (std::size_t c = 0; c < channel_count; ++c) {
            const double scattered = all.static_light[c][b] / light.paths;
            light.static_irradiance[c][b] = static_cast<float>(direct_[c][b] + scattered);
        }
    }
}

}  // namespace drtv::bake
