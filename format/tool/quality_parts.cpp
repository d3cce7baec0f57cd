#include "quality_parts.h"

namespace drtv::tool {
namespace {

constexpr float faint_sky = 0.02f;      // of a white sky
constexpr float faint_lamps = 0.0001f;  // W/m2 of E/pi, a fifth of a lux

// E/pi of the bounce under a sky of radiance 1.
float mean_of(const TransferCodes& transfer) {
    float sum = 0;
    for (const auto& channel : transfer) {
        for (const auto& basis : channel)
            sum += decode_fixed(basis[0], transfer_scale) / sh_y0;
    }
    return sum / (channel_count * basis_count);
}

// Over the directions that see sky at all.
float mean_of(const VisibilityCodes& visibility) {
    constexpr std::size_t upward_count = 3;
    float sum = 0;
    for (std::size_t b = 0; b < upward_count; ++b)
        sum += decode_fixed(visibility[b], sky_visibility_scale);
    return sum / upward_count;
}

float mean_of(const StaticIrradiance& light) {
    float sum = 0;
    for (const auto& channel : light.codes) {
        for (const std::int16_t code : channel)
            sum += decode_fixed(code, scale_of_exponent(light.exponent));
    }
    return sum / (channel_count * basis_count);
}

}  // namespace

std::vector<PartQuality> quality_parts(const Sector& sector, std::size_t p) {
    const Quality& quality = *sector.quality;
    const ProbeQuality& probe = quality.probes[p];
    std::vector<PartQuality> parts = {
        {"transfer", probe.transfer_error, mean_of(sector.probes[p].transfer), faint_sky},
        {"sky visibility", probe.visibility_error, mean_of(sector.probes[p].sky_visibility), faint_sky}};
    if (!sector.static_irradiance.empty())
        parts.push_back(
            {"static light", probe.static_error, mean_of(sector.static_irradiance[p]), faint_lamps});
    // Of groups that were stripped nothing is known but the error.
    if (quality.group_errors.size() != sector.light_groups.size())
        return parts;
    for (std::size_t g = 0; g < sector.light_groups.size(); ++g) {
        const LightGroup& group = sector.light_groups[g];
        parts.push_back({"group '" + group.name + "'",
                         quality.group_errors[g][p],
                         mean_of(group.irradiance[p]),
                         faint_lamps});
    }
    return parts;
}

}  // namespace drtv::tool
