// A baked probe as its sector's file holds it.
#pragma once

#include "bakerd/bake/integrate.h"
#include "bakerd/bake/settings.h"

#include <drtv/sector.h>

#include <cstdint>
#include <span>

namespace drtv::bake {

// A probe's part of its file's statistics.
struct ProbeCounts {
    std::uint32_t paths = 0;
    std::uint32_t rays = 0;
    std::uint32_t shadow_rays = 0;
    std::uint32_t back_hits = 0;
    float error = 0;  // ProbeLight::error
};

inline constexpr int min_static_exponent = -64;

struct BakedProbe {
    TransferCodes transfer{};
    VisibilityCodes sky_visibility{};
    StaticIrradiance static_irradiance{{}, min_static_exponent};
    ProbeCounts counts;
};

[[nodiscard]] BakedProbe encode_probe(const ProbeLight& light);

// Puts the probes' light, and what it cost, into a sector that has as many probes.
void store_probes(std::span<const BakedProbe> probes, Sector& sector);

// REQUIRES: `sector` is of these probes.
[[nodiscard]] Convergence convergence_of(std::span<const BakedProbe> probes, const Settings& settings);

}  // namespace drtv::bake
