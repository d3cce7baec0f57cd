#include "bakerd/picture/true_probes.h"

#include "bakerd/picture/probe_mix.h"
#include "bakerd/trace/device.h"

#include <tbb/parallel_for.h>
#include <glm/common.hpp>

namespace drtv::picture {
namespace {

constexpr std::uint32_t paths_of_a_guess = 2048;

std::size_t number_of(const ProbeShare& probe) {
    return std::size_t{probe.sector->first_probe} + probe.probe;
}

glm::vec3 weighted(const BasisColours& colours, const Float4& weights) {
    glm::vec3 sum(0);
    for (std::size_t b = 0; b < basis_count; ++b)
        sum += as_vec(colours[b]) * weights[b];
    return sum;
}

}  // namespace

Guesses<glm::vec3> shaded(RelightMode mode,
                          Show shown,
                          const Guesses<BasisColours>& colours,
                          const glm::vec3& normal) {
    const Float4 weights = basis_weights(mode, as_float3(normal));
    Guesses<glm::vec3> light = {weighted(colours[0], weights), weighted(colours[1], weights)};
    if (shown != Show::ambient)
        return light;
    // Both or none: what is noise must not decide for one of them.
    const glm::vec3 mean = mean_of(light);
    for (glm::length_t c = 0; c < 3; ++c) {
        if (mean[c] < 0)
            light[0][c] = light[1][c] = 0;
    }
    return light;
}

TrueProbes::TrueProbes(const Moment& moment, const PathLight& path_light, Show shown)
    : moment_(moment),
      path_light_(path_light),
      shown_(shown),
      sector_of_(moment.set().limits().probes),
      colours_(sector_of_.size()) {}

void TrueProbes::ask_for(const glm::vec3& at, const glm::vec3& normal) {
    const ProbeMix mix = mix_at(moment_, at, normal);
    for (std::size_t n = 0; n < mix.count; ++n)
        sector_of_[number_of(mix.probes[n])] = mix.probes[n].sector;
}

void TrueProbes::trace() {
    const bake::SampleTable paths(paths_of_a_guess, path_light_.dimensions());
    tbb::parallel_for(std::size_t{0}, sector_of_.size(), [&](std::size_t n) {
        const LoadedSector* sector = sector_of_[n];
        if (sector == nullptr)
            return;
        const trace::FloatMode float_mode;
        const glm::vec3 place = as_vec(position_m(sector->view, n - sector->first_probe));
        for (int guess = 0; guess < 2; ++guess) {
            const glm::ivec3 seed(static_cast<int>(n), -1, guess);
            colours_[n][static_cast<std::size_t>(guess)] =
                colours_of(path_light_.at_basis(place, paths, seed), shown_);
        }
    });
}

Guesses<glm::vec3> TrueProbes::light(const glm::vec3& at, const glm::vec3& normal) const {
    const ProbeMix mix = mix_at(moment_, at, normal);
    Guesses<BasisColours> sum{};
    for (std::size_t n = 0; n < mix.count; ++n) {
        for (std::size_t guess = 0; guess < 2; ++guess)
            add(sum[guess], colours_[number_of(mix.probes[n])][guess], mix.probes[n].share);
    }
    // What stands in for probes is of the sky alone.
    const bool has_sky = shown_ == Show::ambient || shown_ == Show::sky_direct;
    if (mix.fallback > 0 && has_sky) {
        const float open = moment_.set().sky_factor(as_place(asked_place(at, normal)));
        for (BasisColours& colours : sum)
            add(colours, clamped(open_sky(moment_.light())), mix.fallback * open);
    }
    return shaded(moment_.light().mode, shown_, sum, normal);
}

}  // namespace drtv::picture
