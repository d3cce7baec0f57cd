#include "dot_colour.h"

#include "quality_parts.h"

#include <drtv/relight.h>

#include <algorithm>

namespace drtv::tool {
namespace {

constexpr float exposure = 1.5f;  // of relit colours, so that an open slope at noon is bright but not white
// Where a picture turns red: a relative standard error, and a share of all paths.
constexpr float red_error = 0.1f;
constexpr float red_back_hits = 0.05f;
constexpr Float3 unknown_colour = {0.2f, 0.2f, 0.2f};

// Clear sky at noon and a high sun, in units in which the sky's radiance is about one third.
SceneLight noon() {
    return {.sky = constant_sky({0.24f, 0.32f, 0.46f}),
            .sun = {.irradiance = {3.6f, 3.4f, 3.0f}, .direction = {0.40f, -0.30f, 0.866f}}};
}

// Ambient on a sphere: the mean over normals up and around and down, so that the bounce shows too.
Float3 ambient_of(const Sector& sector, std::size_t p) {
    static const SceneLight light = noon();
    BasisColours colours = relight(sector.probes[p].transfer, sector.probes[p].sky_visibility, light);
    if (!sector.static_irradiance.empty())
        add_static_irradiance(colours, sector.static_irradiance[p]);
    for (const LightGroup& group : sector.light_groups)
        add_static_irradiance(colours, group.irradiance[p]);
    Float3 sum{};
    constexpr std::array<Float3, 6> normals = {
        {{0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, -1}}};
    for (const Float3& normal : normals) {
        const Float3 ambient = shade_ambient(light.mode, clamped(colours), normal);
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += ambient[c] / static_cast<float>(normals.size());
    }
    return sum;
}

// Green at 0, yellow half way, red from 1 on.
Float3 traffic_light(float share) {
    return {std::clamp(2 * share, 0.0f, 1.0f), std::clamp(2 - 2 * share, 0.0f, 1.0f), 0};
}

Float3 error_colour(const Sector& sector, std::size_t p) {
    if (!sector.quality)
        return unknown_colour;
    float largest = 0;
    for (const PartQuality& part : quality_parts(sector, p))
        largest = std::max(largest, part.seen_error());
    return traffic_light(largest / red_error);
}

Float3 back_hit_colour(const Sector& sector, std::size_t p) {
    if (!sector.quality)
        return unknown_colour;
    const ProbeQuality& probe = sector.quality->probes[p];
    const auto paths = static_cast<float>(std::max(probe.paths, 1u));
    return traffic_light(static_cast<float>(probe.back_hits) / paths / red_back_hits);
}

}  // namespace

Float3 dot_colour(const Sector& sector, std::size_t p, float sky_visibility, DotQuantity quantity) {
    switch (quantity) {
        case DotQuantity::relit:
            break;
        case DotQuantity::sky:
            return {sky_visibility, sky_visibility, sky_visibility};
        case DotQuantity::errors:
            return error_colour(sector, p);
        case DotQuantity::back_hits:
            return back_hit_colour(sector, p);
    }
    Float3 colour = ambient_of(sector, p);
    for (float& channel : colour)
        channel *= exposure;
    return colour;
}

}  // namespace drtv::tool
