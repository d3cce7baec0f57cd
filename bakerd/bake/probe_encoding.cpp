#include "bakerd/bake/probe_encoding.h"

#include "bakerd/bake/convergence.h"
#include "bakerd/bake/local_encoding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>

namespace drtv::bake {
namespace {

StaticIrradiance encode_static(const BasisIrradiance& irradiance) {
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

bool is_lit(const StaticIrradiance& light) {
    return light.codes != LightCodes{};
}

// E/pi of its brightest side.
float brightest_side(const StaticIrradiance& light) {
    std::int16_t most = 0;
    for (const auto& channel : light.codes)
        most = std::max(most, *std::ranges::max_element(channel));
    return decode_fixed(most, scale_of_exponent(light.exponent));
}

// What groups bring to the probe that they shine on most. Those that bring no probe as much as
// `least_group_light` are left out: whether a few rays find some of their light is chance.
std::map<std::string, float> groups_that_shine(std::span<const BakedProbe> probes) {
    std::map<std::string, float> most;
    for (const BakedProbe& probe : probes) {
        for (const BakedGroup& group : probe.groups) {
            float& of_group = most[group.name];
            of_group = std::max(of_group, brightest_side(group.irradiance));
        }
    }
    std::erase_if(most, [](const auto& group) { return group.second < min_group_light; });
    return most;
}

tl::expected<void, std::string> store_groups(std::span<const BakedProbe> probes, Sector& sector) {
    const std::map<std::string, float> groups = groups_that_shine(probes);
    if (groups.size() > max_light_groups) {
        std::vector<std::string> shown;
        for (const auto& [name, most] : groups)
            shown.push_back(fmt::format("{} ({:.2g} W/m2)", name, most));
        return tl::unexpected(fmt::format(
            "sector ({}, {}): {} light groups shine on its probes, a file holds at most {}: {}. Give "
            "lights that are switched together one light_group",
            sector.i,
            sector.j,
            groups.size(),
            max_light_groups,
            fmt::join(shown, ", ")));
    }
    for (const auto& [name, most] : groups) {
        LightGroup& group = sector.light_groups.emplace_back();
        std::vector<float>& errors = sector.quality->group_errors.emplace_back();
        group.name = name;
        for (const BakedProbe& probe : probes) {
            const auto of_probe = std::ranges::find(probe.groups, name, &BakedGroup::name);
            const bool found = of_probe != probe.groups.end();
            group.irradiance.push_back(found ? of_probe->irradiance : BakedGroup{}.irradiance);
            errors.push_back(found ? of_probe->error : 0);
        }
    }
    return {};
}

}  // namespace

BakedProbe encode_probe(const ProbeLight& light, std::span<const LightSet> sets) {
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
    for (const StaticLightOfProbe& group : light.groups)
        baked.groups.push_back({sets[group.set].name, encode_static(group.irradiance), group.error});
    ProbeQuality& quality = baked.quality;
    quality.transfer_error = light.transfer_error;
    quality.visibility_error = light.visibility_error;
    quality.static_error = light.static_error;
    quality.paths = light.paths;
    quality.back_hits = static_cast<std::uint32_t>(light.back_hits);
    quality.budget_ended = light.budget_ended;
    baked.counts = {
        static_cast<std::uint32_t>(light.rays), static_cast<std::uint32_t>(light.shadow_rays), light.error};
    return baked;
}

tl::expected<void, std::string> store_probes(std::span<const BakedProbe> probes, Sector& sector) {
    if (probes.empty())
        return {};
    bool lit = false;
    Quality& quality = sector.quality.emplace();
    for (std::size_t p = 0; p < probes.size(); ++p) {
        sector.probes[p].transfer = probes[p].transfer;
        sector.probes[p].sky_visibility = probes[p].sky_visibility;
        sector.statistics.rays += probes[p].counts.rays;
        sector.statistics.back_hits += probes[p].quality.back_hits;
        quality.probes.push_back(probes[p].quality);
        lit |= is_lit(probes[p].static_irradiance);
    }
    // The section is left out where no probe gets any static light.
    for (std::size_t p = 0; lit && p < probes.size(); ++p)
        sector.static_irradiance.push_back(probes[p].static_irradiance);
    return store_groups(probes, sector);
}

bool is_dark(const Sector& sector, std::size_t probe) {
    const Probe& light = sector.probes[probe];
    if (light.sky_visibility != VisibilityCodes{} || light.transfer != TransferCodes{})
        return false;
    if (!sector.static_irradiance.empty() && is_lit(sector.static_irradiance[probe]))
        return false;
    return std::ranges::none_of(sector.light_groups,
                                [probe](const LightGroup& group) { return is_lit(group.irradiance[probe]); });
}

Convergence convergence_of(std::span<const BakedProbe> probes, const settings::BakeSettings& settings) {
    Convergence convergence;
    convergence.error_asked = settings.error;
    std::vector<float> errors;
    for (const BakedProbe& probe : probes) {
        const std::uint32_t paths = probe.quality.paths;
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
