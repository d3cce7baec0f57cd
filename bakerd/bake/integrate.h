// Sky visibility and radiance transfer of one probe (DESIGN section 2; s19-s21), by paths from the probe.
#pragma once

#include "bakerd/bake/sampling.h"
#include "bakerd/trace/scene.h"

#include <drtv/conventions.h>

#include <array>
#include <cstdint>
#include <vector>

namespace drtv::bake {

struct ProbeLight {
    // [channel][basis direction][SH coefficient]: E/pi from a sky of radiance Y_i by up to N bounces.
    std::array<std::array<std::array<float, sh_count>, basis_count>, channel_count> transfer{};
    std::array<float, basis_count> sky_visibility{};  // 1 under an open sky; [3] = 0
    std::uint64_t rays = 0;                           // shot
    std::uint64_t back_hits = 0;                      // of these, absorbed by the back of a one-sided surface
};

struct IntegrationSettings {
    std::uint32_t bounces = 3;
    float reach_m = 512;
};

// A pure function of the triangles within reach and the arguments. `samples` has at least 2 + 2 bounces
// dimensions. With `shot`, the rays are appended to it in their order, so that others can be measured on the same
// ones. REQUIRES: a FloatMode on this thread.
[[nodiscard]] ProbeLight integrate_probe(const trace::Scene& scene, const glm::ivec3& position_units, const SampleTable& samples, const IntegrationSettings& settings,
                                         std::vector<trace::Ray>* shot = nullptr);

}  // namespace drtv::bake
