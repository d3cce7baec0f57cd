// What the talk shows on its slides (GDC 2012; 7 to 12, 53, 55 and 58), on a map like its test scene.
#include "tests/ambient/talk_scene.h"
#include "tests/ambient/moments.h"
#include "tests/ambient/vectors.h"
#include "tests/reference/reference_ambient.h"

#include <drtv/ambient.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace drtv::test {
namespace {

// At a sphere's surface, a hand's breadth off.
glm::vec3 on_sphere(const glm::vec3& middle, const glm::vec3& normal) {
    return middle + (sphere_radius_m + 0.05f) * normal;
}

Ambient ambient_of(const SceneLight& light, const glm::vec3& at, const glm::vec3& normal,
                   std::span<const LightShare> lamps = {}) {
    return ambient_at(baked_talk_scene().set(), light, lamps,
                      {.at = as_place(at), .normal = as_float(normal), .offset_m = surface_offset_m});
}

glm::vec3 colour_of(const Ambient& ambient) {
    return {ambient.colour[0], ambient.colour[1], ambient.colour[2]};
}
glm::vec3 sun_of(const Ambient& ambient) {
    const Float3& sun = ambient.parts.sun_bounce;
    return {sun[0], sun[1], sun[2]};
}

constexpr glm::vec3 east(1, 0, 0), west(-1, 0, 0), up(0, 0, 1), down(0, 0, -1);

TestMoment sun_from(const glm::dvec3& to_sun) {
    return moment_of({.zenith = {0.3f, 0.5f, 1}, .horizon = {0.6f, 0.7f, 0.9f}}, glm::dvec3(9), to_sun);
}

// Slides 7 to 9. How the truth colours each side, the runtime does; it need not be as strong.
TEST(TalkScene, BouncesTheColoursOfWallsAndGround) {
    const reference::Scene scene(baked_talk_scene().map());
    const TestMoment morning = sun_from({1, 0, 0.7});
    const TestMoment evening = sun_from({-1, 0, 0.7});
    const auto truth = [&](const TestMoment& moment, const glm::vec3& at, const glm::vec3& normal) {
        const glm::dvec3 n = normal;
        return reference::ambient(scene, at, {&n, 1}, {&moment.truth, 1}, {})[0][0].total();
    };
    struct Case {
        const TestMoment& moment;
        glm::vec3 middle;
        glm::vec3 normal;
        glm::length_t strong, weak;  // channels
        double within;               // a factor; the runtime does not know that a sphere shades its underside
    };
    const std::array<Case, 4> cases = {{{morning, beside_red, west, 0, 2, 1.6},
                                        {evening, beside_blue, east, 2, 0, 1.6},
                                        {morning, beside_blue, down, 1, 0, 3},
                                        {evening, beside_red, down, 1, 2, 3}}};
    for (const Case& c : cases) {
        const glm::vec3 at = on_sphere(c.middle, c.normal);
        const glm::dvec3 right = truth(c.moment, at, c.normal);
        ASSERT_GT(right[c.strong], 1.3 * right[c.weak]) << "the scene itself";
        const glm::vec3 found = colour_of(ambient_of(c.moment.light, at, c.normal));
        EXPECT_GT(found[c.strong], 1.15f * found[c.weak]) << c.strong;
        EXPECT_GT(found[c.strong], right[c.strong] / c.within);
        EXPECT_LT(found[c.strong], right[c.strong] * c.within);
    }
    // From the other side each wall is in its own shade.
    const glm::vec3 at = on_sphere(beside_red, west);
    EXPECT_GT(sun_of(ambient_of(morning.light, at, west)).r,
              3 * sun_of(ambient_of(evening.light, at, west)).r);
}

// Slides 11 and 12: a lamp that moves, at night.
TEST(TalkScene, ShowsTheBounceOfALampAtNight) {
    SceneLight night;
    std::array<LightShare, max_shares_per_light> shares;
    const PointLight lamp{{15, 32, 2}, {5, 5, 5}};
    const std::size_t count = split_light(baked_talk_scene().set(), lamp, shares);
    const glm::vec3 facing = on_sphere(beside_red, west);
    const glm::vec3 lit = colour_of(ambient_of(night, facing, west, {shares.data(), count}));
    EXPECT_EQ(colour_of(ambient_of(night, facing, west)), glm::vec3(0));
    EXPECT_GT(lit.r, 0.02f);
    EXPECT_GT(lit.r, 1.5f * lit.b) << "off the red wall";
    const glm::vec3 far =
        colour_of(ambient_of(night, on_sphere(beside_blue, east), east, {shares.data(), count}));
    EXPECT_LT(far.r, 0.2f * lit.r);
}

// Slide 53: the sky is brighter on the side of the sun, which has just set.
TEST(TalkScene, MakesAWallMoreOrangeTowardsTheSunset) {
    const reference::Scene scene(baked_talk_scene().map());
    TestMoment sunset =
        moment_of({.zenith = {0.2f, 0.3f, 0.6f}, .horizon = {0.4f, 0.4f, 0.5f}, .sun_side = {1, 0.5f, 0.1f}},
                  glm::dvec3(9), {-1, 0.1, -0.01});
    for (const auto& [mode, error] : {std::pair(RelightMode::literal, 0.25), {RelightMode::accurate, 0.15}}) {
        sunset.light.mode = mode;
        const auto orange = [&, allowed = error](float x, const glm::vec3& normal) {
            const glm::vec3 at(x, 32, 2);
            const glm::vec3 found = colour_of(ambient_of(sunset.light, at, normal));
            const glm::dvec3 n = normal;
            const glm::dvec3 truth =
                reference::ambient(scene, at, {&n, 1}, {&sunset.truth, 1}, {})[0][0].total();
            EXPECT_NEAR(found.r / found.b, truth.r / truth.b, allowed * truth.r / truth.b);
            return found.r / found.b;
        };
        EXPECT_GT(orange(white_wall_x - 0.05f, west), 1.5f * orange(white_wall_x + 1.05f, east));
    }
}

// Slide 55: under a blue sky that lights all, a hut's inside gets what its door lets in.
TEST(TalkScene, ShowsNoBlueInside) {
    SceneLight sky;
    sky.sky = constant_sky({0, 0, 1});
    TestMoment same;
    same.truth.sky = [](const glm::dvec3&) { return glm::dvec3(0, 0, 1); };
    const reference::Scene scene(baked_talk_scene().map());
    double found = 0;
    double truth = 0;
    double as_outside = 0;
    for (int n = 0; n < 9; ++n) {
        const glm::vec3 at(hut_low.x + 1 + 2 * static_cast<float>(n % 3),
                           hut_low.y + 1 + 2 * static_cast<float>(n / 3), -0.45f);
        found += static_cast<double>(ambient_of(sky, at, up).colour[2]);
        as_outside += static_cast<double>(
            ambient_at(baked_talk_scene().set(), sky, {},
                       {.at = as_place(at), .offset_m = surface_offset_m, .interiors = false})
                .colour[2]);
        const glm::dvec3 normal = up;
        truth += reference::ambient(scene, at, {&normal, 1}, {&same.truth, 1}, {})[0][0].total().z;
    }
    EXPECT_LT(found, 9 * 0.06);
    EXPECT_LT(found, 2 * truth);
    EXPECT_GT(found, truth / 4) << "what the door lets in";
    EXPECT_GT(as_outside, 3 * found) << "that interiors do it";
    const glm::vec3 roof(47, 11, hut_high.z + 0.35f);
    EXPECT_GT(ambient_of(sky, roof, up).colour[2], 0.7f);
}

// Slide 58: beyond the volumes, and when the sectors themselves are gone, their tiles tell the jungle from
// the clearing.
TEST(TalkScene, KeepsTheJunglesContrastInTheDistance) {
    OwnedSet set;
    for (const Sector& sector : baked_talk_scene().files())
        set.add(sector);
    SceneLight sky;
    sky.sky = constant_sky({1, 1, 1});
    OwnedRelit relit(set->limits());
    relit->set_light(Shown::now, sky);
    OwnedVolume volume({.outdoors = true}, set->limits());
    volume->update(*set, *relit, {-1000, 0, 0});
    const auto far = [&](const glm::vec3& at) {
        return ambient_in(*volume, *set, sky, {}, {.at = as_place(at), .offset_m = 0}).colour[1];
    };
    const float jungle = far(under_leaves);
    const float clearing = far(in_clearing);
    const reference::Scene scene(baked_talk_scene().map());
    reference::Moment moment;
    moment.sky = [](const glm::dvec3&) { return glm::dvec3(1); };
    const glm::dvec3 normal = up;
    const auto truth = [&](const glm::vec3& at) {
        return reference::ambient(scene, at, {&normal, 1}, {&moment, 1}, {})[0][0].total().y;
    };
    EXPECT_LT(jungle, 0.5f * clearing);
    EXPECT_NEAR(jungle / clearing, truth(under_leaves) / truth(in_clearing), 0.15);
    for (const SectorId id : {SectorId{0, 0}, SectorId{1, 0}, SectorId{2, 0}})
        ASSERT_TRUE(set->drop(id));
    set->retire();
    volume->update(*set, *relit, {-1000, 0, 0});
    EXPECT_EQ(far(under_leaves), jungle);
    EXPECT_EQ(far(in_clearing), clearing);
    OwnedSet unknown;
    EXPECT_EQ(unknown->sky_factor(as_place(under_leaves)), 1) << "that it is the tiles";
}

}  // namespace
}  // namespace drtv::test
