// Local radiance transfer (docs/design.md, section 2; slides 22 to 23 and slides 30 to 31; Kristensen et al.
// 2005): what the bounce of a white point light at each source brings to each probe.
#pragma once

#include "bakerd/bake/ray_watch.h"
#include "bakerd/bake/sampling.h"
#include "bakerd/trace/scene.h"

#include <drtv/conventions.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace drtv::bake {

// Around a light the inverse square stops to grow at this distance, so that a lamp at a wall does not burn it
// out.
inline constexpr float local_least_distance_m = 0.5f;

struct LocalSettings {
    std::uint32_t bounces = 2;  // surface bounces, at least 1
    float reach_m = 512;        // of a receiver: surfaces and sources beyond it do not count
};

// SH coefficients [channel][i] of E/pi as a function of the normal, for a light of 1 W/sr.
using LocalCoefficients = std::array<std::array<float, sh_count>, channel_count>;

// Of each receiver: the indices of the sources that it takes light from, ascending.
using SourcesOfReceivers = std::vector<std::vector<std::uint32_t>>;

struct LocalLight {
    std::vector<std::vector<LocalCoefficients>> pairs;  // [receiver][n], n of its n-th source
    std::uint64_t rays = 0;                             // of paths and shadows
};

// Numbers per path that `samples` should have.
[[nodiscard]] std::uint32_t local_sample_dimensions(std::uint32_t bounces);

// Positions in units of 2^-10 m; samples.count() paths are traced from each. The first sources are the
// receivers, as many as `wanted` has. A pure function of the triangles within reach of them and of the
// arguments. Runs on the calling thread's TBB arena; the same numbers on any threads. Every segment is told
// of with the whole range as its shares.
[[nodiscard]] LocalLight integrate_local(const trace::Scene& scene,
                                         std::span<const glm::ivec3> sources,
                                         const SourcesOfReceivers& wanted,
                                         const SampleTable& samples,
                                         const LocalSettings& settings,
                                         const WatchOfThread& watch = {});

}  // namespace drtv::bake
