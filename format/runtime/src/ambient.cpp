#include <drtv/ambient.h>

#include "vector.h"

#include <cmath>

namespace drtv {
namespace {

void add(Float3& sum, const Float3& value, float factor) {
    for (std::size_t c = 0; c < channel_count; ++c)
        sum[c] += factor * value[c];
}

void add(BasisColours& sum, const BasisColours& value, float factor) {
    for (std::size_t b = 0; b < basis_count; ++b)
        add(sum[b], value[b], factor);
}

Float3 weighted(const BasisColours& colours, const Float4& weights) {
    Float3 sum{};
    for (std::size_t b = 0; b < basis_count; ++b)
        add(sum, colours[b], weights[b]);
    return sum;
}

// Gathers probes with their shares.
class Gathering {
  public:
    Gathering(const SceneLight& light, std::span<const LightShare> lights, const Float4& weights)
        : light_(light), lights_(lights), weights_(weights) {
        sky_.mode = sun_.mode = static_.mode = light.mode;
        sky_.sky = light.sky;
        sun_.sun = light.sun;
        static_.groups = light.groups;
        static_.static_colour = light.static_colour;
        static_.other_groups = light.other_groups;
    }

    void add_probe(const LoadedSector& sector, std::size_t p, float share) {
        const SectorView& view = sector.view;
        const LocalRelighter local(sector, lights_);
        BasisColours colours = relight(view, p, light_);
        local.add_to(colours, p);
        add(colours_, clamped(colours), share);

        BasisColours lamps{};
        local.add_to(lamps, p);
        add_part(parts_.sky_direct, relight(TransferCodes{}, view.sky_visibility[p], sky_), share);
        add_part(parts_.sky_bounce, relight(view.transfer[p], VisibilityCodes{}, sky_), share);
        add_part(parts_.sun_bounce, relight(view.transfer[p], VisibilityCodes{}, sun_), share);
        add_part(parts_.static_light, relight(view, p, static_), share);
        add_part(parts_.local, lamps, share);
    }

    void add_fallback(float sky_factor, float share) {
        BasisColours colours{};
        add(colours, open_sky(light_), sky_factor);
        add(colours_, clamped(colours), share);
        add_part(parts_.fallback, colours, share);
    }

    [[nodiscard]] const BasisColours& colours() const { return colours_; }
    [[nodiscard]] const AmbientParts& parts() const { return parts_; }

  private:
    void add_part(Float3& part, const BasisColours& colours, float share) {
        add(part, weighted(colours, weights_), share);
    }

    const SceneLight& light_;
    std::span<const LightShare> lights_;
    Float4 weights_;
    SceneLight sky_;
    SceneLight sun_;
    SceneLight static_;
    BasisColours colours_{};
    AmbientParts parts_;
};

PlaceStatus status_of(const ProbeBlend& blend, float interior) {
    if (interior >= 1)
        return PlaceStatus::inside;
    const bool only_fallback = blend.count == 0;
    return only_fallback && interior > 0 ? PlaceStatus::fading : blend.status;
}

}  // namespace

Ambient ambient_at(const SectorSet& set,
                   const SceneLight& light,
                   std::span<const LightShare> lights,
                   const AmbientPlace& place) {
    Ambient ambient;
    Double3 asked = place.at;
    if (is_finite(place.normal) && std::isfinite(place.offset_m)) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            asked[axis] += double{place.offset_m} * double{place.normal[axis]};
    }
    const ProbeBlend nearest = set.nearest(asked);
    if (nearest.count > 0)
        ambient.probe = nearest.probes[0];
    const ProbeBlend blend = place.sampling == Sampling::nearest ? nearest : set.trilinear(asked);
    if (place.interiors)
        ambient.interior = set.interior(place.at, place.interior_soft_m);

    Gathering gathering(light, lights, basis_weights(light.mode, place.normal));
    const float indoors = ambient.interior.share;
    if (indoors > 0) {
        const LoadedSector& sector = *ambient.interior.sector;
        gathering.add_probe(sector, sector.view.interiors[ambient.interior.index].probe, indoors);
    }
    if (indoors < 1) {
        for (std::size_t n = 0; n < blend.count; ++n) {
            const ProbeShare& probe = blend.probes[n];
            gathering.add_probe(*probe.sector, probe.probe, probe.share * (1 - indoors));
        }
        if (blend.fallback > 0)
            gathering.add_fallback(set.sky_factor(asked), blend.fallback * (1 - indoors));
    }
    ambient.status = status_of(blend, indoors);
    ambient.colours = gathering.colours();
    ambient.parts = gathering.parts();
    ambient.colour = shade_ambient(light.mode, ambient.colours, place.normal);
    return ambient;
}

}  // namespace drtv
