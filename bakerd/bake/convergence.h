// How far an estimate has come, from what blocks of its own samples say.
#pragma once

#include <drtv/conventions.h>

#include <array>
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
inline constexpr double least_mean = 0.02;

using BlockMeans =
    std::array<std::array<std::array<double, basis_count>, channel_count>, block_count>;  // [block][c][b]

// Standard error of the mean over blocks: root mean square over channels and directions, over the mean or
// `least_mean`.
[[nodiscard]] double relative_error(const BlockMeans& means);

// Median, 95th percentile and maximum; zeros of nothing.
struct ErrorSummary {
    float median = 0;
    float p95 = 0;
    float max = 0;
};
[[nodiscard]] ErrorSummary summarise(std::vector<float> errors);

}  // namespace drtv::bake
