#include "bakerd/picture/moment.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <numbers>

namespace drtv::picture {
namespace {

constexpr float sun_cosine = 1 - 0x1.8p-17f;  // of half its disc's angle, 0.274 degrees

}  // namespace

void add(BasisColours& sum, const BasisColours& colours, float share) {
    for (std::size_t b = 0; b < basis_count; ++b) {
        for (std::size_t c = 0; c < channel_count; ++c)
            sum[b][c] += share * colours[b][c];
    }
}

VolumeSettings volume_settings(const RelightChoice& choice) {
    VolumeSettings settings;
    settings.encoding = choice.encoding;
    settings.outdoors = choice.interiors;
    return settings;
}

Moment::Moment(const SectorSet& set,
               const kit::RequestedLight& light,
               const RelightChoice& choice,
               const Double3& window)
    : set_(set),
      light_(light),
      choice_(choice),
      shares_(kit::split_lamps(set, light.lamps)),
      relit_(set, light.light, shares_, volume_settings(choice)),
      volume_(choice.by == By::volume ? &relit_.at(window) : nullptr),
      open_sky_(clamped(open_sky(light.light))) {}

Ambient Moment::ambient(const glm::vec3& at, const glm::vec3& normal) const {
    AmbientPlace place;
    place.at = as_place(at);
    place.normal = as_float3(normal);
    place.offset_m = surface_offset_m;
    place.interiors = choice_.interiors;
    place.sampling = choice_.by == By::nearest ? Sampling::nearest : Sampling::trilinear;
    return volume_ != nullptr ? ambient_in(*volume_, set_, light(), shares_, place)
                              : ambient_at(set_, light(), shares_, place);
}

glm::vec3 Moment::ambient_colour(const glm::vec3& at, const glm::vec3& normal) const {
    const Double3 asked = as_place(asked_place(at, normal));
    BasisColours sum{};
    float outside = 1;
    if (choice_.interiors) {
        const InteriorShare interior = set_.interior(asked);
        if (interior.share > 0) {
            const std::uint8_t probe = interior.sector->view.interiors[interior.index].probe;
            add(sum, relit_.relit().colours(*interior.sector, probe), interior.share);
            outside -= interior.share;
        }
    }
    if (outside > 0 && volume_ != nullptr) {
        const Volume::Sample sample = volume_->sample(asked);
        add(sum, sample.colours, outside * sample.weight);
        if (sample.weight < 1)
            add(sum, open_sky_, outside * (1 - sample.weight) * set_.sky_factor(asked));
    } else if (outside > 0) {
        const ProbeBlend named = choice_.by == By::nearest ? set_.nearest(asked) : set_.trilinear(asked);
        add_blend(sum, choice_.interiors ? set_.outdoors(named) : named, asked, outside);
    }
    return as_vec(shade_ambient(light().mode, sum, as_float3(normal)));
}

void Moment::add_blend(BasisColours& sum, const ProbeBlend& blend, const Double3& asked, float share) const {
    for (std::size_t n = 0; n < blend.count; ++n) {
        const ProbeShare& probe = blend.probes[n];
        add(sum, relit_.relit().colours(*probe.sector, probe.probe), share * probe.share);
    }
    if (blend.fallback > 0)
        add(sum, open_sky_, share * blend.fallback * set_.sky_factor(asked));
}

std::optional<Incidence> Moment::sun() const {
    const Sun& sun = light().sun;
    if (!(sun.direction[2] > 0))
        return std::nullopt;
    return Incidence{glm::normalize(as_vec(sun.direction)), as_vec(sun.irradiance), std::nullopt};
}

glm::vec3 Moment::factor_of(std::string_view group) const {
    if (group.empty())
        return as_vec(light().static_colour);
    Float3 factor = light().other_groups;
    for (const GroupColour& named : light().groups) {
        if (named.name == group)
            factor = named.colour;
    }
    return as_vec(factor);
}

glm::vec3 Moment::sky(const glm::vec3& direction, bool with_sun) const {
    glm::vec3 w = direction;
    if (w.z < 0) {
        w.z = 0;
        const float length = glm::length(w);
        w = length > 0 ? w / length : glm::vec3(1, 0, 0);
    }
    const Float4 harmonics = evaluate_sh(as_float3(w));
    glm::vec3 radiance(0);
    for (glm::length_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < sh_count; ++i)
            radiance[c] += light().sky[static_cast<std::size_t>(c)][i] * harmonics[i];
    }
    const std::optional<Incidence> disc = with_sun ? sun() : std::nullopt;
    if (disc && glm::dot(direction, disc->direction) > sun_cosine) {
        constexpr float solid_angle = 2 * std::numbers::pi_v<float> * (1 - sun_cosine);
        radiance += disc->irradiance / solid_angle;
    }
    return glm::max(radiance, glm::vec3(0));
}

}  // namespace drtv::picture
