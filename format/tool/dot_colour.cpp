#include "dot_colour.h"

#include "quality_parts.h"

#include <drtv/relight.h>

#include <algorithm>
#include <array>
#include <utility>

namespace drtv::tool {
namespace {

// Where a picture turns red: a relative standard error, and a share of all paths.
constexpr float red_error = 0.1f;
constexpr float red_back_hits = 0.05f;

constexpr Float3 green = {0, 1, 0};
constexpr Float3 yellow = {1, 1, 0};
constexpr Float3 red = {1, 0, 0};
constexpr Float3 blue = {0.05f, 0.25f, 1};
constexpr Float3 orange = {1, 0.35f, 0};

// Relit colours at noon are multiplied by this, so that an open slope is bright but not white.
constexpr float noon_exposure = 1.5f;

// Clear sky at noon and a high sun, in units in which the sky's radiance is about one third.
SceneLight noon() {
    return {.sky = constant_sky({0.24f, 0.32f, 0.46f}),
            .sun = {.irradiance = {3.6f, 3.4f, 3.0f}, .direction = {0.40f, -0.30f, 0.866f}},
            .other_groups = {1, 1, 1}};
}

Float3 scaled(Float3 colour, float factor) {
    for (float& channel : colour)
        channel *= factor;
    return colour;
}

Float3 factor_of(const LightGroup& group, const SceneLight& light) {
    Float3 factor = light.other_groups;
    for (const GroupColour& named : light.groups) {
        if (named.name == group.name)
            factor = named.colour;
    }
    return factor;
}

// Ambient on a sphere: the mean over normals up and around and down, so that the bounce shows too.
Float3 on_sphere(const BasisColours& colours, RelightMode mode) {
    constexpr std::array<Float3, 6> normals = {
        {{0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, -1}}};
    Float3 sum{};
    for (const Float3& normal : normals) {
        const Float3 ambient = shade_ambient(mode, clamped(colours), normal);
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += ambient[c] / static_cast<float>(normals.size());
    }
    return sum;
}

void add_own_light(const Sector& sector, std::size_t p, const SceneLight& light, BasisColours& colours) {
    if (!sector.static_irradiance.empty())
        add_static_irradiance(colours, sector.static_irradiance[p], light.static_colour);
    for (const LightGroup& group : sector.light_groups)
        add_static_irradiance(colours, group.irradiance[p], factor_of(group, light));
}

Float3 relit(const Sector& sector, std::size_t p, const SceneLight& light) {
    BasisColours colours = relight(sector.probes[p].transfer, sector.probes[p].sky_visibility, light);
    add_own_light(sector, p, light, colours);
    return on_sphere(colours, light.mode);
}

Float3 own_light(const Sector& sector, std::size_t p) {
    BasisColours colours{};
    const SceneLight all{.other_groups = {1, 1, 1}};
    add_own_light(sector, p, all, colours);
    return on_sphere(colours, all.mode);
}

DotQuantity noon_relit() {
    const SceneLight light = noon();
    return {"",
            "ambient light on a sphere at each probe, under a clear sky at noon",
            [light](const Sector& sector, std::size_t p, float) {
                return scaled(relit(sector, p, light), noon_exposure);
            },
            {}};
}

DotQuantity sky() {
    return {"",
            "sky visibility of the probes",
            [](const Sector&, std::size_t, float visibility) {
                return scaled({1, 1, 1}, visibility);
            },
            {{{0, 0, 0}, "no sky"}, {{0.5f, 0.5f, 0.5f}, "half of it"}, {{1, 1, 1}, "all of it"}}};
}

DotQuantity static_light() {
    return {"",
            "light of the map's own lamps and glowing surfaces at the probes, direct and bounced",
            [](const Sector& sector, std::size_t p, float) { return own_light(sector, p); },
            {},
            true};
}

DotQuantity dark() {
    return {"",
            "dark probes, which neither the sky nor a light of the map reaches",
            [](const Sector& sector, std::size_t p, float) {
                if (!sector.quality)
                    return unknown_colour;
                return sector.quality->probes[p].dark ? red : green;
            },
            {{red, "dark"}, {green, "lit"}},
            false,
            true};
}

DotQuantity kind() {
    return {"",
            "why the probes stand where they stand",
            [](const Sector& sector, std::size_t p, float) {
                if (sector.quality && sector.quality->probes[p].moved)
                    return orange;
                switch (sector.probes[p].kind) {
                    case ProbeKind::ground:
                        return yellow;
                    case ProbeKind::vegetation:
                        return green;
                    case ProbeKind::manual:
                        return blue;
                }
                return unknown_colour;
            },
            {{yellow, "on the ground"},
             {green, "in vegetation"},
             {blue, "hand-placed"},
             {orange, "moved out of a solid"}}};
}

DotQuantity errors() {
    return {"",
            "largest relative standard error of the parts of a probe's light",
            [](const Sector& sector, std::size_t p, float) {
                if (!sector.quality)
                    return unknown_colour;
                float largest = 0;
                for (const PartQuality& part : quality_parts(sector, p))
                    largest = std::max(largest, part.seen_error());
                return traffic_light(largest / red_error);
            },
            {{green, "0"}, {yellow, "5 %"}, {red, "10 % or more"}},
            false,
            true};
}

// Tells holes in a map and walls that face the wrong way.
DotQuantity back_hits() {
    return {"",
            "share of a probe's paths that meet the back of a one-sided surface",
            [](const Sector& sector, std::size_t p, float) {
                if (!sector.quality)
                    return unknown_colour;
                const ProbeQuality& probe = sector.quality->probes[p];
                const auto paths = static_cast<float>(std::max(probe.paths, 1u));
                return traffic_light(static_cast<float>(probe.back_hits) / paths / red_back_hits);
            },
            {{green, "0"}, {yellow, "2.5 %"}, {red, "5 % or more"}},
            false,
            true};
}

constexpr std::array<std::pair<const char*, DotQuantity (*)()>, 7> quantities = {{{"relit", noon_relit},
                                                                                  {"sky", sky},
                                                                                  {"static", static_light},
                                                                                  {"dark", dark},
                                                                                  {"kind", kind},
                                                                                  {"errors", errors},
                                                                                  {"back_hits", back_hits}}};

cli::Result<DotQuantity> relit_at(const kit::LightRequest& request) {
    const auto light = std::make_shared<kit::RequestedLight>();
    if (auto read = kit::read_light(request, "preview", *light); !read)
        return tl::unexpected(read.error());
    return DotQuantity{
        "",
        "ambient light on a sphere at each probe, at " + *request.time,
        [light](const Sector& sector, std::size_t p, float) { return relit(sector, p, light->light); },
        {},
        true};
}

}  // namespace

Float3 traffic_light(float share) {
    return {std::clamp(2 * share, 0.0f, 1.0f), std::clamp(2 - 2 * share, 0.0f, 1.0f), 0};
}

std::vector<std::string> dot_quantity_names() {
    std::vector<std::string> names;
    for (const auto& [name, make] : quantities)
        names.emplace_back(name);
    return names;
}

cli::Result<DotQuantity> dot_quantity(const std::string& name, const kit::LightRequest& light) {
    if (light.time && name != "relit")
        return cli::fail(cli::exit_usage, "preview: --time goes with --quantity relit");
    if (light.time) {
        auto made = relit_at(light);
        if (made)
            made->name = name;
        return made;
    }
    const auto* known =
        std::ranges::find_if(quantities, [&](const auto& quantity) { return name == quantity.first; });
    DotQuantity made = known->second();
    made.name = name;
    return made;
}

}  // namespace drtv::tool
