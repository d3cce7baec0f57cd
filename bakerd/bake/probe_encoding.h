// A baked probe as its sector's file holds it.
#pragma once

#include "bakerd/bake/integrate.h"
#include "settings/bake_settings.h"

#include <drtv/sector.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::bake {

// A probe's part of its file's statistics.
struct ProbeCounts {
    std::uint32_t rays = 0;
    std::uint32_t shadow_rays = 0;
    float error = 0;  // ProbeLight::error
};

inline constexpr int min_static_exponent = -64;

// A sector's file holds a light group that brings any of its probes so much E/pi, W/m2: a tenth of full moon.
inline constexpr float min_group_light = 1e-5f;

// What a light group brings to a probe.
struct BakedGroup {
    std::string name;
    StaticIrradiance irradiance{{}, min_static_exponent};
    float error = 0;  // StaticLightOfProbe::error
};

struct BakedProbe {
    TransferCodes transfer{};
    VisibilityCodes sky_visibility{};
    StaticIrradiance static_irradiance{{}, min_static_exponent};
    std::vector<BakedGroup> groups;  // by name
    ProbeQuality quality;            // but for what other parts of the bake know: dark, moved
    ProbeCounts counts;
};

// `sets` are those of the lights that it was integrated with.
[[nodiscard]] BakedProbe encode_probe(const ProbeLight& light, std::span<const LightSet> sets);

// Puts the probes' light, what is known of it, and what it cost, into a sector that has as many probes. Fails
// with a sentence where more light groups than a file holds shine on them.
[[nodiscard]] tl::expected<void, std::string> store_probes(std::span<const BakedProbe> probes,
                                                           Sector& sector);

// Whether neither the sky nor any light of the map reaches the sector's probe.
[[nodiscard]] bool is_dark(const Sector& sector, std::size_t probe);

// REQUIRES: `sector` is of these probes.
[[nodiscard]] Convergence convergence_of(std::span<const BakedProbe> probes,
                                         const settings::BakeSettings& settings);

}  // namespace drtv::bake
