// Sky visibility, radiance transfer and static irradiance by brute force, written from docs/design.md,
// section 2 alone: uniform directions everywhere, double precision, no code of the product's integrator.
// Slow, and right but for a known noise.
#pragma once

#include "tests/reference/reference_scene.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace drtv::reference {

inline constexpr std::size_t basis_count = 4, sh_count = 4, channel_count = 3;

// docs/design.md, section 1, with all digits.
inline const std::array<glm::dvec3, basis_count> basis = {
    {{-0.40824829046386302, -0.70710678118654752, 0.57735026918962576},
     {-0.40824829046386302, 0.70710678118654752, 0.57735026918962576},
     {0.81649658092772603, 0, 0.57735026918962576},
     {0, 0, -1}}};
inline constexpr double y0 = 0.28209479177387814, y1 = 0.48860251190291992;

using Transfer =
    std::array<std::array<std::array<double, sh_count>, basis_count>, channel_count>;  // [c][b][i]
using Visibility = std::array<double, basis_count>;
using Irradiance = std::array<std::array<double, basis_count>, channel_count>;  // [c][b]: E/pi, W/(sr m2)

struct Estimate {
    Transfer transfer{}, transfer_error{};  // means and their standard errors
    Visibility sky_visibility{}, visibility_error{};
    Irradiance static_irradiance{}, static_error{};
};

// Paths are batches x strata^2 x continuation_strata^2. First directions are jittered in strata x strata
// cells of equal solid angle, and so are the directions that go on from each first hit. Batches are
// independent; the standard errors are those of the mean over batches. Emission is found by the paths that
// hit it; all other lights are summed over at each surface, and at the probe itself.
struct Options {
    std::uint32_t bounces =
        3;                 // surfaces that may scatter on a path; after the last one it finds sky or emission
    double reach_m = 512;  // farther from the probe is sky, at every bounce
    std::uint32_t batches = 32;  // 2 or more
    std::uint32_t strata = 64;
    std::uint32_t continuation_strata = 1;
    std::uint64_t seed = 1;
};

[[nodiscard]] Estimate integrate(const Scene& scene, const glm::dvec3& position, const Options& options);

}  // namespace drtv::reference
