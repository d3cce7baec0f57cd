// How far an estimate has come, from what blocks of its own samples say.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace drtv::bake {

inline constexpr std::size_t block_count = 8;

// Blocks of one Sobol sequence lie better spread together than each alone: the error of their mean is smaller
// than their spread says, by this factor (tests/bake/convergence_test measures it: root mean square over
// probes and settings).
inline constexpr double block_correction = 0.75;

// An error counts against the mean, or against this where the mean is smaller: E/pi under a sky of radiance
// 1, or W/m2.
inline constexpr double min_mean = 0.02;

// Of so many numbers that are estimated together, for instance channels and directions.
template <std::size_t count>
using BlockMeans = std::array<std::array<double, count>, block_count>;

// Each block becomes the sum of two, in order; the upper half of them is empty then. `add` adds a block to
// another.
template <class Block, class Add>
void pair_blocks(std::array<Block, block_count>& blocks, Add add) {
    for (std::size_t k = 0; k < block_count / 2; ++k) {
        Block pair = blocks[2 * k];
        add(pair, blocks[2 * k + 1]);
        blocks[k] = pair;
    }
    std::fill(blocks.begin() + block_count / 2, blocks.end(), Block{});
}

// What blocks say of their mean.
struct ErrorOfMean {
    double error = 0;  // standard error, root mean square over the numbers
    double mean = 0;   // over the numbers

    // Over the mean or `min_mean`.
    [[nodiscard]] double over_mean() const { return error / (mean > min_mean ? mean : min_mean); }
    // Over the mean; 0 where that is none.
    [[nodiscard]] double on_own_scale() const { return mean > 0 ? error / mean : 0; }
};

template <std::size_t count>
[[nodiscard]] ErrorOfMean error_of_mean(const BlockMeans<count>& means) {
    double variance = 0;
    double total = 0;
    for (std::size_t n = 0; n < count; ++n) {
        double sum = 0;
        double squares = 0;
        for (const auto& block : means) {
            sum += block[n];
            squares += block[n] * block[n];
        }
        const double mean = sum / block_count;
        total += mean;
        variance += std::max(0.0, squares / block_count - mean * mean) / (block_count - 1);
    }
    return {block_correction * std::sqrt(variance / count), total / count};
}

// Median, 95th percentile and maximum; zeros of nothing.
struct ErrorSummary {
    float median = 0;
    float p95 = 0;
    float max = 0;
};
[[nodiscard]] ErrorSummary summarise(std::vector<float> errors);

}  // namespace drtv::bake
