#include "bakerd/bake/probe_encoding.h"

#include "bakerd/bake/convergence.h"
#include "bakerd/bake/local_encoding.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace drtv::bake {
namespace {

StaticIrradiance encode_static(const BasisColours& irradiance) {
    float largest = 0;
    for (const auto& channel : irradiance)
        largest = std::max(largest, *std::ranges::max_element(channel));
    StaticIrradiance encoded;
    encoded.exponent = static_cast<std::int8_t>(exponent_of(largest, min_static_exponent));
    const auto scale = scale_of_exponent(encoded.exponent);
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b)
            encoded.codes[c][b] = encode_fixed(irradiance[c][b], scale);
    }
    return encoded;
}

}  // namespace

BakedProbe encode_probe(const ProbeLight& light) {
    BakedProbe baked;
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b) {
            for (std::size_t i = 0; i < sh_count; ++i)
                baked.transfer[c][b][i] = encode_fixed(light.transfer[c][b][i], transfer_scale);
        }
    }
    for (std::size_t b = 0; b < basis_count; ++b)
        baked.sky_visibility[b] = encode_fixed(light.sky_visibility[b], sky_visibility_scale);
    baked.static_irradiance = encode_static(light.static_irradiance);
    baked.counts = {light.paths,
                    static_cast<std::uint32_t>(light.rays),
                    static_cast<std::uint32_t>(light.shadow_rays),
                    static_cast<std::uint32_t>(light.back_hits),
                    light.error};
    return baked;
}

void store_probes(std::span<const BakedProbe> probes, Sector& sector) {
    bool lit = false;
    for (std::size_t p = 0; p < probes.size(); ++p) {
        sector.probes[p].transfer = probes[p].transfer;
        sector.probes[p].sky_visibility = probes[p].sky_visibility;
        sector.statistics.rays += probes[p].counts.rays;
        sector.statistics.back_hits += probes[p].counts.back_hits;
        lit |= probes[p].static_irradiance.codes != LightCodes{};
    }
    // The section is left out where no probe gets any static light.
    if (!lit)
        return;
    for (const BakedProbe& probe : probes)
        sector.static_irradiance.push_back(probe.static_irradiance);
}

Convergence convergence_of(std::span<const BakedProbe> probes, const Settings& settings) {
    Convergence convergence;
    convergence.error_asked = settings.error;
    std::vector<float> errors;
    for (const BakedProbe& probe : probes) {
        const std::uint32_t paths = probe.counts.paths;
        const std::uint32_t least = errors.empty() ? paths : convergence.paths_least;
        convergence.paths_least = std::min(least, paths);
        convergence.paths_most = std::max(convergence.paths_most, paths);
        convergence.static_rays += probe.counts.shadow_rays;
        errors.push_back(probe.counts.error);
    }
    const ErrorSummary summary = summarise(std::move(errors));
    convergence.error_median = summary.median;
    convergence.error_p95 = summary.p95;
    convergence.error_max = summary.max;
    return convergence;
}

}  // namespace drtv::bake
