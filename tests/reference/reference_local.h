// Local radiance transfer by brute force, from docs/design.md, section 2 alone: paths from the receiver, and
// at each surface that they touch the light of every source.
#pragma once

#include "tests/reference/reference_integrator.h"

#include <span>
#include <vector>

namespace drtv::reference {

using LocalTransfer = std::array<std::array<double, sh_count>, channel_count>;  // [c][i]: SH of E/pi per W/sr

struct LocalEstimate {
    LocalTransfer transfer{}, transfer_error{};  // means and their standard errors
};

// Paths are batches x strata^2, as for Options; `bounces` is of surfaces that scatter, 1 or more. A source
// farther from the receiver than the reach sends nothing.
struct LocalOptions {
    std::uint32_t bounces = 1;
    double reach_m = 512;
    std::uint32_t batches = 32;  // 2 or more
    std::uint32_t strata = 64;
    std::uint64_t seed = 1;
};

// One estimate a source.
[[nodiscard]] std::vector<LocalEstimate> integrate_local(const Scene& scene, const glm::dvec3& receiver,
                                                         std::span<const glm::dvec3> sources,
                                                         const LocalOptions& options);

}  // namespace drtv::reference
