#include "bakerd/reuse/static_gain.h"

#include "bakerd/reuse/footprint_record.h"
#include "tests/bake/worlds.h"

#include <gtest/gtest.h>

#include <numbers>

namespace drtv::test {
namespace {

constexpr float albedo = 0.5f;

struct LampsOverAPlane {
    std::shared_ptr<bake::World> world;
    std::shared_ptr<const trace::Scene> scene;
    std::vector<placement::Position> probes = {{0, 0, 1024}};
    settings::BakeSettings settings;

    // Lamps of 683 cd (1 W/sr in the green that an eye sees best) so high above the plane.
    explicit LampsOverAPlane(const std::vector<glm::dvec3>& lamps) {
        GltfBuilder b;
        b.add_node(
            {.mesh = b.add_mesh(ground(100), b.add_material({.colour = {albedo, albedo, albedo, 1}}))});
        for (const glm::dvec3& lamp : lamps)
            b.add_node({.light = b.add_light({{"type", "point"}, {"intensity", 683}}),
                        .translation = glm::dvec3(lamp.x, lamp.z, -lamp.y)});
        world = open_world(b);
        scene = world->scene_for({0, 0}, 200);
        settings.bounces = 1;
        settings.reach_m = 80;
    }

    [[nodiscard]] float gain() const {
        return reuse::static_gain(world->lights(), world->max_scattered(), *scene, probes, settings);
    }
    // What the plane radiates so near to one of the lamps, as a share of the range.
    [[nodiscard]] float gain_at(float distance_m) const {
        const glm::vec3& intensity = world->lights().points()[0].intensity;
        return albedo * std::numbers::inv_pi_v<float> * std::max({intensity.x, intensity.y, intensity.z}) /
               (distance_m * distance_m) / bake::static_irradiance_range;
    }
};

TEST(StaticGain, FollowsTheNearestSurface) {
    EXPECT_EQ(LampsOverAPlane({}).gain(), 0);
    const LampsOverAPlane low({{5, 5, 0.5}}), high({{5, 5, 4}});
    EXPECT_FLOAT_EQ(low.gain(), low.gain_at(0.5f));
    EXPECT_FLOAT_EQ(high.gain(), high.gain_at(4));
    // Beyond the reach of the probe.
    EXPECT_EQ(LampsOverAPlane({{90, 0, 0.5}}).gain(), 0);
}

TEST(StaticGain, LampsSideBySideCountTogether) {
    const LampsOverAPlane pair({{5, 5, 1}, {5, 5.2, 1}});
    EXPECT_GE(pair.gain(), pair.gain_at(1) + pair.gain_at(1.02f) * 0.999f);  // under one of them
    EXPECT_LE(pair.gain(), 2.001f * pair.gain_at(1));
    const LampsOverAPlane apart({{5, 5, 1}, {5, 45, 1}});
    EXPECT_GE(apart.gain(), apart.gain_at(1) + apart.gain_at(40.02f) * 0.999f);
    EXPECT_LE(apart.gain(), 1.01f * apart.gain_at(1));
}

TEST(StaticGain, AllBouncesCount) {
    LampsOverAPlane lamp({{5, 5, 1}});
    const float once = lamp.gain();
    lamp.settings.bounces = 3;
    EXPECT_FLOAT_EQ(lamp.gain(), once * (1 + albedo + albedo * albedo));
}

TEST(StaticGain, GrowsWithTheSurfaces) {
    settings::BakeSettings settings;
    settings.bounces = 2;
    EXPECT_EQ(reuse::raised_gain(3, 0.5f, 0.5f, settings), 3);
    EXPECT_EQ(reuse::raised_gain(3, 0.5f, 0.2f, settings), 3);
    EXPECT_FLOAT_EQ(reuse::raised_gain(3, 0.5f, 0.75f, settings), 3 * 1.5f * 1.5f);
}

TEST(StaticGain, OfBoxesIsByTheirDistance) {
    const LampsOverAPlane lamp({{5, 5, 4}});
    const auto of_box = [&](const map::Bounds& box) {
        return reuse::static_gain(lamp.world->lights(), lamp.world->max_scattered(), std::vector{box},
                                  lamp.settings);
    };
    EXPECT_FLOAT_EQ(of_box({{7, 4, 3}, {8, 6, 5}}), lamp.gain_at(2));
    EXPECT_EQ(of_box({{500, 500, 0}, {501, 501, 1}}), 0);
    // Around the lamp: more than any tolerance, and a number.
    EXPECT_GT(of_box({{0, 0, 0}, {9, 9, 9}}), 1e5f);
    EXPECT_LT(of_box({{0, 0, 0}, {9, 9, 9}}), 1e9f);
}

}  // namespace
}  // namespace drtv::test
