#include <drtv/ambient.h>

#include "share_batches.h"
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
        BasisColours colours = relight(view, p, light_);
        BasisColours lamps{};
        for_each_batch(sector, lights_, [&](const LocalRelighter& local) {
            local.add_to(colours, p);
            local.add_to(lamps, p);
        });
        add(colours_, clamped(colours), share);

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

    // The sky's factor is that of `world_m`, which is asked for where the fallback has a share.
    void add_blend(const ProbeBlend& blend, const SectorSet& set, const Double3& world_m, float share) {
        if (!(share > 0))
            return;
        for (std::size_t n = 0; n < blend.count; ++n) {
            const ProbeShare& probe = blend.probes[n];
            add_probe(*probe.sector, probe.probe, probe.share * share);
        }
        if (blend.fallback > 0)
            add_fallback(set.sky_factor(world_m), blend.fallback * share);
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

Double3 asked_place(const AmbientPlace& place) {
    Double3 asked = place.at;
    if (is_finite(place.normal) && std::isfinite(place.offset_m)) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            asked[axis] += double{place.offset_m} * double{place.normal[axis]};
    }
    return asked;
}

// What is known but for the light outside; an interior's probe is gathered.
Ambient indoors_of(const SectorSet& set,
                   const AmbientPlace& place,
                   const Double3& asked,
                   const ProbeBlend& nearest,
                   Gathering& gathering) {
    Ambient ambient;
    if (nearest.count > 0)
        ambient.probe = nearest.probes[0];
    if (place.interiors)
        ambient.interior = set.interior(asked, place.interior_soft_m);
    const auto& [sector, index, share] = ambient.interior;
    if (share > 0)
        gathering.add_probe(*sector, sector->view.interiors[index].probe, share);
    return ambient;
}

void finish(Ambient& ambient,
            const Gathering& gathering,
            const BasisColours& colours,
            RelightMode mode,
            const AmbientPlace& place) {
    ambient.colours = colours;
    ambient.parts = gathering.parts();
    ambient.colour = shade_ambient(mode, colours, place.normal);
}

// Calls `use(centre, blend, share)` for the eight texels around a place, each of which holds the probe that
// its centre names. Gives a blend with the status of all.
template <class Use>
ProbeBlend blend_of_texels(const SectorSet& set,
                           const VolumeSettings& settings,
                           const Double3& world_m,
                           const Use& use) {
    ProbeBlend all;
    for (int n = 0; n < 8; ++n) {
        float share = 1;
        Double3 centre{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double width = double{settings.texel_m[axis]};
            const double texels = world_m[axis] / width - 0.5;
            const double low = std::floor(texels);
            const auto above = static_cast<float>(texels - low);
            const bool next = (n >> axis & 1) != 0;
            share *= next ? above : 1 - above;
            centre[axis] = (low + (next ? 1.5 : 0.5)) * width;
        }
        if (!(share > 0))
            continue;
        const ProbeBlend named = set.nearest(centre);
        const ProbeBlend texel = settings.outdoors ? set.outdoors(named) : named;
        all.count += texel.count;
        all.fallback += share * texel.fallback;
        if (texel.count == 0)
            all.status = texel.status;
        use(centre, texel, share);
    }
    if (all.count > 0)
        all.status = all.fallback > 0 ? PlaceStatus::fading : PlaceStatus::inside;
    return all;
}

}  // namespace

Ambient ambient_at(const SectorSet& set,
                   const SceneLight& light,
                   std::span<const LightShare> lamps,
                   const AmbientPlace& place) {
    const Double3 asked = asked_place(place);
    const ProbeBlend nearest = set.nearest(asked);
    const ProbeBlend named = place.sampling == Sampling::nearest ? nearest : set.trilinear(asked);
    const ProbeBlend blend = place.interiors ? set.outdoors(named) : named;
    Gathering gathering(light, lamps, basis_weights(light.mode, place.normal));
    Ambient ambient = indoors_of(set, place, asked, nearest, gathering);
    gathering.add_blend(blend, set, asked, 1 - ambient.interior.share);
    ambient.status = status_of(blend, ambient.interior.share);
    finish(ambient, gathering, gathering.colours(), light.mode, place);
    return ambient;
}

Ambient ambient_in(const Volume& volume,
                   const SectorSet& set,
                   const SceneLight& light,
                   std::span<const LightShare> lamps,
                   const AmbientPlace& place) {
    const Double3 asked = asked_place(place);
    const Volume::Sample sample = volume.sample(asked);
    Gathering gathering(light, lamps, basis_weights(light.mode, place.normal));
    Ambient ambient = indoors_of(set, place, asked, set.nearest(asked), gathering);
    const float outdoors = 1 - ambient.interior.share;
    BasisColours colours = gathering.colours();
    Gathering distance(light, lamps, basis_weights(light.mode, place.normal));
    const float sky_factor = set.sky_factor(asked);
    distance.add_fallback(sky_factor, 1);
    add(colours, sample.colours, outdoors * sample.weight);
    add(colours, distance.colours(), outdoors * (1 - sample.weight));

    ProbeBlend blend;
    blend.fallback = 1;
    if (sample.weight > 0) {
        blend = blend_of_texels(
            set, volume.settings(), asked, [&](const Double3& centre, const ProbeBlend& texel, float share) {
                gathering.add_blend(texel, set, centre, outdoors * sample.weight * share);
            });
    }
    if (sample.weight < 1)
        gathering.add_fallback(sky_factor, outdoors * (1 - sample.weight));
    const bool fades = sample.weight > 0 && sample.weight < 1 && blend.status == PlaceStatus::inside;
    if (fades)
        blend.status = PlaceStatus::fading;
    ambient.status = status_of(blend, ambient.interior.share);
    finish(ambient, gathering, colours, light.mode, place);
    return ambient;
}

}  // namespace drtv
