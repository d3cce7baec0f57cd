#include "bakerd/bake/probe_sums.h"

#include "bakerd/map/colour.h"

#include <algorithm>

namespace drtv::bake {
namespace {

constexpr std::size_t upper = static_cast<std::size_t>(Half::upper);
constexpr std::size_t lower = static_cast<std::size_t>(Half::lower);

// Basis directions that see sky at all.
constexpr std::size_t upward_count = 3;

// The share of a cosine lobe around the basis direction that lies above the horizon, and below.
std::array<double, 2> lobe_shares(std::size_t b) {
    const double above = (1 + static_cast<double>(transfer_basis[b][2])) / 2;
    return {above, 1 - above};
}

}  // namespace

void ProbeSums::Block::add(const Block& other) {
    for (const std::size_t half : {upper, lower}) {
        for (std::size_t b = 0; b < basis_count; ++b)
            weights[half][b] += other.weights[half][b];
        bake::add(bounced[half], other.bounced[half]);
    }
    bake::add(seen, other.seen);
    for (std::size_t b = 0; b < basis_count; ++b)
        visible[b] += other.visible[b];
}

void ProbeSums::pair_blocks() {
    bake::pair_blocks(blocks_, [](Block& sum, const Block& more) { sum.add(more); });
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
        block_->visible[b] += static_cast<double>(weights[b] * share);
    bake::add(block_->seen, weights, throughput);
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
    bake::add(block_->bounced[h], weights, throughput);
}

template <class Lit>
ErrorOfMean ProbeSums::error_of(Lit lit) const {
    BlockMeans<channel_count * basis_count> relit{};
    for (std::size_t k = 0; k < block_count; ++k) {
        const Block& block = blocks_[k];
        for (std::size_t b = 0; b < basis_count; ++b) {
            const std::array<double, 2> share = lobe_shares(b);
            for (const std::size_t half : {upper, lower}) {
                const double weight = block.weights[half][b];
                if (weight <= 0)
                    continue;
                for (std::size_t c = 0; c < channel_count; ++c)
                    relit[k][c * basis_count + b] += share[half] * lit(block, half, c, b) / weight;
            }
        }
    }
    return error_of_mean(relit);
}

ErrorOfMean ProbeSums::error() const {
    return error_of([](const Block& block, std::size_t half, std::size_t c, std::size_t b) {
        return block.bounced[half][c][b] + (half == upper ? block.seen[c][b] : 0);
    });
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
            light.sky_visibility[b] = static_cast<float>(all.visible[b] / all.weights[upper][b]);
    }
    const ErrorOfMean bounced =
        error_of([](const Block& block, std::size_t half, std::size_t c, std::size_t b) {
            return block.bounced[half][c][b];
        });
    light.transfer_error = static_cast<float>(bounced.on_own_scale());
    BlockMeans<upward_count> visible{};
    for (std::size_t k = 0; k < block_count; ++k) {
        for (std::size_t b = 0; b < upward_count; ++b) {
            if (blocks_[k].weights[upper][b] > 0)
                visible[k][b] = blocks_[k].visible[b] / blocks_[k].weights[upper][b];
        }
    }
    light.visibility_error = static_cast<float>(error_of_mean(visible).on_own_scale());
}

}  // namespace drtv::bake
