// What one probe gets from sky and static lights (docs/design.md, section 2; slides 19 to 21), by paths from
// the probe.
#pragma once

#include "bakerd/bake/lights.h"
#include "bakerd/bake/ray_watch.h"
#include "bakerd/bake/sampling.h"
#include "bakerd/trace/scene.h"

#include <drtv/conventions.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace drtv::bake {

using BasisIrradiance =
    std::array<std::array<float, basis_count>, channel_count>;  // [channel][basis direction]

// Of one set of lights (lights.h) to one probe.
struct StaticLightOfProbe {
    std::size_t set = 0;
    BasisIrradiance irradiance{};  // E/pi, W/m2, direct and bounced
    float error = 0;  // standard error over the mean of these, at most 1; 1 of light that no path found
};

struct ProbeLight {
    // [channel][basis direction][SH coefficient]: E/pi from a sky of radiance Y_i by up to N bounces.
    std::array<std::array<std::array<float, sh_count>, basis_count>, channel_count> transfer{};
    std::array<float, basis_count> sky_visibility{};  // 1 under an open sky; [3] = 0
    BasisIrradiance static_irradiance{};              // E/pi, W/m2, direct and bounced, of lights in no group
    std::vector<StaticLightOfProbe> groups;           // of light groups within reach, by set
    std::uint32_t paths = 0;                          // shot from the probe
    float error = 0;                                  // reached, as IntegrationSettings::error has it
    bool budget_ended = false;                        // before the error that was asked for was reached
    // Standard errors over the mean of the same numbers, each on its own scale (SPEC.md, section 5.13).
    float transfer_error = 0;
    float visibility_error = 0;
    float static_error = 0;         // of static_irradiance
    std::uint64_t rays = 0;         // of the paths
    std::uint64_t shadow_rays = 0;  // to static lights
    std::uint64_t back_hits = 0;    // rays absorbed by the back of a one-sided surface
    // Of back_hits the share of each object of the map that has one; by object.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> back_hit_objects;
};

struct IntegrationSettings {
    std::uint32_t bounces = 3;
    float reach_m = 512;
    // Standard error to stop at, of E/pi relit by a sky of radiance 1 and of static irradiance of each set,
    // over their mean (ErrorOfMean::over_mean). Paths are doubled from 1,024 as long as it is not reached and
    // the samples have as many. 0: all samples.
    float error = 0;
};

// Numbers per path that `samples` should have.
[[nodiscard]] std::uint32_t sample_dimensions(std::uint32_t bounces, bool with_lights);

// A pure function of the triangles and lights within reach and the arguments. `samples` has at least
// sample_dimensions(bounces, false) dimensions. `watch`, where there is one, is told of every ray, but for
// the few that are looked at twice. REQUIRES: a FloatMode on this thread.
[[nodiscard]] ProbeLight integrate_probe(const trace::Scene& scene,
                                         const StaticLights& lights,
                                         const glm::ivec3& position_units,
                                         const SampleTable& samples,
                                         const IntegrationSettings& settings,
                                         RayWatch* watch = nullptr);

}  // namespace drtv::bake
