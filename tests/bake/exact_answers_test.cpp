// The exact answers of docs/design.md, section 2, at the ray counts users bake with.
#include "bakerd/bake/sector_bake.h"
#include "tests/bake/worlds.h"

#include <gtest/gtest.h>
#include <glm/gtc/constants.hpp>

#include <array>
#include <cmath>
#include <random>

namespace drtv::test {
namespace {

constexpr std::uint32_t rays = 2048;

// Sums of 2,048 floats in double: what remains is the rounding of single weights.
constexpr double rounding = 1e-5;

// From 1 m above a plane, what lies beyond the reach of 512 m is a strip 1/512 high below the horizon:
// 0.52/512 of a lobe that leans to the horizon, and 2,048 samples meet it two times, give or take two.
constexpr double horizon_strip = 3 * 0.52 / 512;

// The part of a lobe around the three upward directions that lies above the horizon, (1 + 0.577350) / 2.
constexpr std::array<double, 4> open_share = {0.788675, 0.788675, 0.788675, 0};

TEST(ExactAnswers, NoGeometryGivesOpenSkyAndNoTransfer) {
    GltfBuilder b;
    b.add_node({.mesh = b.add_mesh(ground(1, -2000), b.add_material({}))});  // beyond the reach
    const auto world = open_world(b);
    const bake::ProbeLight light = light_at(*world, {3, 4, 5}, rays);
    EXPECT_EQ(light.sky_visibility, (std::array<float, 4>{1, 1, 1, 0}));
    for (const auto& channel : light.transfer) {
        for (const auto& row : channel)
            EXPECT_EQ(row, (std::array<float, 4>{0, 0, 0, 0}));
    }
}

TEST(ExactAnswers, PlaneSendsItsAlbedoBackToTheDownwardDirection) {
    for (const float albedo : {0.2f, 0.5f, 0.9f}) {
        GltfBuilder b;
        b.add_node(
            {.mesh = b.add_mesh(ground(20000), b.add_material({.colour = {albedo, albedo / 2, 0, 1}}))});
        const auto world = open_world(b);
        const bake::ProbeLight light = light_at(*world, {0, 0, 1}, rays);
        // Hits within the reach of 512 m cover the lower half up to 1/512 of it.
        const double covered = 1 - 1 / (512.0 * 512.0);
        EXPECT_NEAR(under_constant_sky(light, 0, 3), static_cast<double>(albedo) * covered, 1e-4);
        EXPECT_NEAR(under_constant_sky(light, 1, 3), static_cast<double>(albedo) / 2 * covered, 1e-4);
        EXPECT_EQ(under_constant_sky(light, 2, 3), 0);
        for (std::size_t basis = 0; basis < 3; ++basis) {
            EXPECT_EQ(light.sky_visibility[basis], 1);
            EXPECT_NEAR(under_constant_sky(light, 0, basis),
                        static_cast<double>(albedo) * (1 - open_share[basis]),
                        static_cast<double>(albedo) * horizon_strip);
        }
    }
}

// Rooms of several sizes and places: the coordinates' precision must not open a gap at edges and corners.
TEST(ExactAnswers, ClosedRoomIsBlackToTheLastBit) {
    for (const float offset_m : {0.0f, 37.3f, 1000.7f, 9001.1f}) {
        GltfBuilder b;
        b.add_node({.mesh = b.add_mesh(room({-2, 0, -3}, {2, 3, 3}),
                                       b.add_material({.colour = {0.9f, 0.9f, 0.9f, 1}})),
                    .translation = glm::dvec3(offset_m, 10, -offset_m),
                    .rotation = glm::dvec4(0, std::sin(0.3), 0, std::cos(0.3))});
        const auto world = open_world(b);
        for (const glm::vec3& place :
             {glm::vec3(0, 0, 11.5f), glm::vec3(0.5f, 1, 10.01f), glm::vec3(-1, -1, 12.9f)}) {
            const bake::ProbeLight light =
                light_at(*world, place + glm::vec3(offset_m, offset_m, 0), 16384, 8);
            EXPECT_EQ(light.sky_visibility, (std::array<float, 4>{0, 0, 0, 0})) << offset_m;
            for (const auto& channel : light.transfer) {
                for (const auto& row : channel)
                    EXPECT_EQ(row, (std::array<float, 4>{0, 0, 0, 0})) << offset_m;
            }
            EXPECT_EQ(light.back_hits, 0u) << offset_m;
        }
    }
}

// A tent: the roof meets the floor at 10 degrees, where a start off the surface could slip through.
TEST(ExactAnswers, RoomWithAcuteCornersIsBlackToTheLastBit) {
    for (const float offset_m : {0.0f, 300.5f}) {
        const float h = 5 * std::tan(glm::pi<float>() / 18);
        const glm::vec3 a(-5, 0, -5), c(5, 0, -5), d(5, 0, 5), e(-5, 0, 5), r0(-5, h, 0), r1(5, h, 0);
        Shape tent;
        tent.positions = {a, c, d, e, r0, r1};
        // Fronts inwards: floor up, roof down, gables towards the middle.
        tent.indices = {0, 3, 2, 0, 2, 1, 3, 4, 5, 3, 5, 2, 0, 1, 5, 0, 5, 4, 0, 4, 3, 1, 2, 5};
        GltfBuilder b;
        b.add_node({.mesh = b.add_mesh(tent, b.add_material({.colour = {0.95f, 0.95f, 0.95f, 1}})),
                    .translation = glm::dvec3(offset_m, 0, 0)});
        const auto world = open_world(b);
        const bake::ProbeLight light = light_at(*world, {offset_m, 0, 0.4f}, 65536, 8);
        EXPECT_EQ(light.sky_visibility, (std::array<float, 4>{0, 0, 0, 0}));
        for (const auto& channel : light.transfer) {
            for (const auto& row : channel)
                EXPECT_EQ(row, (std::array<float, 4>{0, 0, 0, 0}));
        }
    }
}

TEST(ExactAnswers, SurfaceSeenFromBehindIsNeitherSkyNorBounce) {
    GltfBuilder b;
    b.add_node({.mesh = b.add_mesh(room({-1, -1, -1}, {1, 1, 1}), b.add_material({}))});
    const auto world = open_world(b);
    // From outside, looking at backs only where the box is.
    const bake::ProbeLight light = light_at(*world, {0, 0, -1.5f}, rays);
    EXPECT_GT(light.back_hits, 0u);
    EXPECT_LT(light.sky_visibility[0], 0.5f);
    EXPECT_EQ(under_constant_sky(light, 0, 0), 0);
}

// Energy: T[b] . sky + v[b] o[b] <= 1 for any passive scene, here for bright random clutter.
TEST(ExactAnswers, EnergyOfBrightClutterStaysBelowOne) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-20, 20), size(0.5f, 4);
    GltfBuilder b;
    const int white = b.add_material({.colour = {0.95f, 0.95f, 0.95f, 1}, .double_sided = true});
    b.add_node({.mesh = b.add_mesh(ground(60), white)});
    for (int n = 0; n < 60; ++n) {
        const glm::vec3 low(place(random), std::abs(place(random)) * 0.3f, place(random)),
            extent(size(random), size(random), size(random));
        b.add_node({.mesh = b.add_mesh(box(low, low + extent), white)});
    }
    const auto world = open_world(b);
    for (int n = 0; n < 24; ++n) {
        const bake::ProbeLight light =
            light_at(*world, {place(random), place(random), std::abs(place(random)) * 0.4f}, 512, 8);
        for (std::size_t basis = 0; basis < basis_count; ++basis) {
            EXPECT_LE(under_constant_sky(light, 0, basis) +
                          static_cast<double>(light.sky_visibility[basis]) * open_share[basis],
                      1 + rounding);
            EXPECT_GE(light.transfer[0][basis][0], 0);
        }
    }
}

TEST(ExactAnswers, BakedPlaneSectorHoldsThemInItsFile) {
    GltfBuilder b;
    b.add_node({.mesh = b.add_mesh(ground(1000), b.add_material({.colour = {0.5f, 0.25f, 0.125f, 1}}))});
    const auto world = open_world(b);
    settings::BakeSettings settings;
    settings.rays = 256;
    const auto baked = bake::bake_sector(*world, {0, 0}, settings);
    ASSERT_TRUE(baked) << baked.error();
    const Sector& sector = baked->sector;
    EXPECT_EQ(sector.probes.size(), 64u);  // every 8 m
    for (const Probe& probe : sector.probes) {
        EXPECT_EQ(probe.sky_visibility, (std::array<std::int16_t, 4>{32767, 32767, 32767, 0}));
        EXPECT_EQ(position_m(sector, probe)[2], 1.0f);
        // One step of the fixed point, and the strip beyond the reach.
        const double step = 0.5 / 32767 / static_cast<double>(sh_y0);
        EXPECT_NEAR(static_cast<double>(decode_fixed(probe.transfer[0][3][0], transfer_scale)) /
                        static_cast<double>(sh_y0),
                    0.5, step + 1e-4);
        EXPECT_NEAR(static_cast<double>(decode_fixed(probe.transfer[1][3][0], transfer_scale)) /
                        static_cast<double>(sh_y0),
                    0.25, step + 1e-4);
    }
    EXPECT_FALSE(encoded(sector).empty());
}

}  // namespace
}  // namespace drtv::test
