// The reference against answers known on paper: what all of its tests share. L below is what a surface sends
// back when the sky's radiance is Y_i: albedo / pi times the integral of the cosine and Y_i over the sky that
// it sees.
#pragma once

#include "tests/reference/gltf_builder.h"
#include "tests/reference/reference_integrator.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <array>
#include <numbers>
#include <string>

namespace drtv::reference {

using std::numbers::pi;
using Radiance = std::array<double, sh_count>;

// Seeds are fixed, so a test that passes stays passed; 5 standard errors (32 batches) leave a new seed 1
// chance in 40 over all numbers here together.
inline constexpr double sigmas = 5;
// A test whose noise grew past this would say nothing: under 0.4 % of the largest answers.
inline constexpr double largest_transfer_error = 0.001, largest_visibility_error = 0.004;
// The "infinite" plane has this half side; at a reach of half of it and a probe 1 m away the rest is 4e-10.
inline constexpr float infinite_m = 1e5f;
inline constexpr Options plane_options{.reach_m = 5e4, .continuation_strata = 2};
inline constexpr double exact_arithmetic = 1e-9;  // what the plane lacks, and double's rounding of sums
inline constexpr double float_input = 1e-6;       // colours and corners come in as floats

inline constexpr double albedo_r = 0.5, albedo_g = 0.25, albedo_b = 0.9;
inline constexpr std::array<double, channel_count> albedo = {albedo_r, albedo_g, albedo_b};
inline constexpr glm::vec4 colour_rgb(0.5f, 0.25f, 0.9f, 1);

inline map::Map one_patch(const Patch& patch, const Surfacing& surfacing, const Placement& placement = {},
                          const std::string& role = "static") {
    GltfBuilder builder;
    builder.place(builder.add_mesh(patch, builder.add_material(surfacing)), placement, role);
    return builder.import();
}

inline Patch ground_patch() {
    Patch patch;
    patch.add_quad({-infinite_m, -infinite_m, 0}, {infinite_m, -infinite_m, 0}, {infinite_m, infinite_m, 0},
                   {-infinite_m, infinite_m, 0});
    return patch;
}

inline void expect_transfer(const Estimate& estimate, const Transfer& expected, double allowance) {
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b) {
            for (std::size_t i = 0; i < sh_count; ++i) {
                const double error = estimate.transfer_error[c][b][i];
                EXPECT_LT(error, largest_transfer_error);
                EXPECT_NEAR(estimate.transfer[c][b][i], expected[c][b][i], sigmas * error + allowance)
                    << "channel " << c << ", basis " << b << ", SH " << i;
            }
        }
    }
}

inline void expect_visibility(const Estimate& estimate, const Visibility& expected, double allowance) {
    for (std::size_t b = 0; b < basis_count; ++b) {
        EXPECT_LT(estimate.visibility_error[b], largest_visibility_error);
        EXPECT_NEAR(estimate.sky_visibility[b], expected[b],
                    sigmas * estimate.visibility_error[b] + allowance)
            << "basis " << b;
    }
}

// Surfaces that all send back albedo x `unit`, as seen around b with the weight share[b].
inline Transfer uniform_transfer(const Radiance& unit, const std::array<double, basis_count>& share,
                                 const std::array<double, channel_count>& reflectances = albedo) {
    Transfer transfer{};
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b) {
            for (std::size_t i = 0; i < sh_count; ++i)
                transfer[c][b][i] = reflectances[c] * unit[i] * share[b];
        }
    }
    return transfer;
}

// Of the cosine around b, the part on the side of the plane to which `normal` points.
inline std::array<double, basis_count> half_space_share(const glm::dvec3& normal) {
    std::array<double, basis_count> share{};
    for (std::size_t b = 0; b < basis_count; ++b)
        share[b] = (1 + glm::dot(basis[b], normal)) / 2;
    return share;
}

// Ground under an open sky: int of cos and cos^2 over the hemisphere are pi and 2 pi / 3.
inline constexpr Radiance ground_sends = {y0, 0, y1 * 2 / 3, 0};

}  // namespace drtv::reference
