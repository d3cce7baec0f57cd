#include "bakerd/picture/probe_mix.h"

#include <cmath>

namespace drtv::picture {
namespace {

void add_blend(ProbeMix& mix, const SectorSet& set, bool outdoors, const ProbeBlend& named, float share) {
    const ProbeBlend blend = outdoors ? set.outdoors(named) : named;
    for (std::size_t n = 0; n < blend.count; ++n)
        mix.add(blend.probes[n], blend.probes[n].share * share);
    mix.fallback += blend.fallback * share;
}

// A texel shows the probe that its middle names.
void add_texels(
    ProbeMix& mix, const SectorSet& set, const Volume& volume, const Double3& asked, float share) {
    const VolumeSettings& settings = volume.settings();
    for (int n = 0; n < 8; ++n) {
        float of_texel = share;
        Double3 middle{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double width = double{settings.texel_m[axis]};
            const double texels = asked[axis] / width - 0.5;
            const double low = std::floor(texels);
            const auto above = static_cast<float>(texels - low);
            const bool next = (n >> axis & 1) != 0;
            of_texel *= next ? above : 1 - above;
            middle[axis] = (low + (next ? 1.5 : 0.5)) * width;
        }
        if (of_texel > 0)
            add_blend(mix, set, settings.outdoors, set.nearest(middle), of_texel);
    }
}

}  // namespace

ProbeMix mix_at(const Moment& moment, const glm::vec3& at, const glm::vec3& normal) {
    const SectorSet& set = moment.set();
    const RelightChoice& choice = moment.choice();
    const Double3 asked = as_place(asked_place(at, normal));
    ProbeMix mix;
    float outside = 1;
    if (choice.interiors) {
        const InteriorShare interior = set.interior(asked);
        if (interior.share > 0) {
            const std::uint8_t probe = interior.sector->view.interiors[interior.index].probe;
            mix.add({interior.sector, probe, 1}, interior.share);
            outside -= interior.share;
        }
    }
    if (!(outside > 0))
        return mix;
    const Volume* volume = moment.volume();
    if (volume == nullptr) {
        const ProbeBlend blend = choice.by == By::nearest ? set.nearest(asked) : set.trilinear(asked);
        add_blend(mix, set, choice.interiors, blend, outside);
        return mix;
    }
    const float within = volume->sample(asked).weight;
    if (within > 0)
        add_texels(mix, set, *volume, asked, outside * within);
    mix.fallback += outside * (1 - within);
    return mix;
}

}  // namespace drtv::picture
