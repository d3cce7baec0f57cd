// What a picture asks of the runtime beside the runtime itself.
#include "bakerd/picture/moment.h"

#include "bakerd/picture/probe_mix.h"
#include "bakerd/picture/texel_age.h"
#include "tests/picture/yard.h"

#include <drtv/relight.h>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <numbers>
#include <random>

namespace drtv::test {
namespace {

using picture::By;
using picture::Moment;
using picture::RelightChoice;

constexpr Double3 window = {60, 30, 2};

struct Place {
    glm::vec3 at, normal;
};

// Inside of the sectors, beside and above them, in the hut and far away.
std::vector<Place> places() {
    std::mt19937 random(17);
    std::uniform_real_distribution<float> share(-1, 1);
    std::vector<Place> found;
    for (int n = 0; n < 600; ++n) {
        const float reach = n % 5 == 0 ? 400.0f : 90.0f;
        glm::vec3 at(60 + reach * share(random), 30 + reach * share(random), 8 + 10 * share(random));
        if (n % 7 == 0)
            at = glm::vec3(47, 11, 1.5f) +
                 glm::vec3(3.5f, 3.5f, 2) * glm::vec3(share(random), share(random), share(random));
        found.push_back({at, glm::normalize(glm::vec3(share(random), share(random), share(random) + 1e-3f))});
    }
    return found;
}

std::vector<RelightChoice> choices() {
    std::vector<RelightChoice> all;
    for (const By by : {By::nearest, By::trilinear, By::volume}) {
        for (const bool interiors : {true, false})
            all.push_back({by, TexelEncoding::rgba16f, interiors});
    }
    return all;
}

TEST(Moment, ColourAloneIsTheColourOfAll) {
    const auto light = morning();
    for (const RelightChoice& choice : choices()) {
        const Moment moment(baked_yard().set(), *light, choice, window);
        int bright = 0;
        for (const Place& place : places()) {
            const glm::vec3 all = picture::as_vec(moment.ambient(place.at, place.normal).colour);
            const glm::vec3 alone = moment.ambient_colour(place.at, place.normal);
            // Eleven bits, of colours that weights may take from each other.
            EXPECT_LT(glm::distance(all, alone), 2e-3f * (glm::length(all) + 4));
            bright += glm::length(all) > 0.5f ? 1 : 0;
        }
        EXPECT_GT(bright, 400);
    }
}

TEST(ProbeMix, SharesMakeWhatTheRuntimeBlends) {
    const auto light = morning();
    light->lamps.clear();
    const SectorSet& set = baked_yard().set();
    for (const RelightChoice& choice : choices()) {
        const Moment moment(set, *light, choice, window);
        int of_probes_alone = 0;
        for (const Place& place : places()) {
            const picture::ProbeMix mix = mix_at(moment, place.at, place.normal);
            float shares = mix.fallback;
            glm::vec3 sum(0);
            BasisColours colours{};
            for (std::size_t n = 0; n < mix.count; ++n) {
                shares += mix.probes[n].share;
                const BasisColours probe =
                    clamped(relight(mix.probes[n].sector->view, mix.probes[n].probe, light->light));
                for (std::size_t b = 0; b < basis_count; ++b) {
                    for (std::size_t c = 0; c < channel_count; ++c)
                        colours[b][c] += mix.probes[n].share * probe[b][c];
                }
            }
            EXPECT_NEAR(shares, 1, 1e-5f);
            if (mix.fallback > 0)
                continue;
            ++of_probes_alone;
            const glm::vec3 found =
                picture::as_vec(shade_ambient(light->light.mode, colours, picture::as_float3(place.normal)));
            const glm::vec3 right = picture::as_vec(moment.ambient(place.at, place.normal).colour);
            EXPECT_LT(glm::distance(found, right), 2e-3f * (glm::length(right) + 4));
        }
        EXPECT_GT(of_probes_alone, 200);
    }
}

TEST(Moment, SkyIsTheGradientAndHasASun) {
    kit::RequestedLight light;
    const Float3 to_sun = {0.6f, 0, 0.8f};
    light.light.sky = gradient_sky({{1, 2, 3}, {4, 5, 6}, {0, 0, 0}}, to_sun);
    light.light.sun = {{100, 90, 80}, to_sun};
    const Moment moment(baked_yard().set(), light, {}, window);
    const auto near = [](const glm::vec3& a, const glm::vec3& b) { return glm::distance(a, b) < 1e-4f; };
    EXPECT_TRUE(near(moment.sky({0, 0, 1}, false), {1, 2, 3}));
    EXPECT_TRUE(near(moment.sky({0, 1, 0}, false), {4, 5, 6}));
    EXPECT_TRUE(near(moment.sky({0, 0.8f, -0.6f}, false), {4, 5, 6})) << "below the horizon it goes on";
    EXPECT_TRUE(near(moment.sky({0, 0, -1}, false), {4, 5, 6}));
    // All of the sun's light comes from its disc.
    const glm::vec3 of_disc = moment.sky({0.6f, 0, 0.8f}, true) - moment.sky({0.6f, 0, 0.8f}, false);
    EXPECT_NEAR(of_disc.x * 2 * std::numbers::pi_v<float> * 0x1.8p-17f, 100, 0.01f);
    EXPECT_EQ(moment.sky({0.5f, 0, 0.8660254f}, true), moment.sky({0.5f, 0, 0.8660254f}, false));
}

TEST(Moment, GroupsHaveTheirFactors) {
    kit::RequestedLight light;
    light.light.static_colour = {1, 2, 3};
    // The last of a name counts, as for the runtime.
    light.groups = {{"lanterns", {3, 3, 3}}, {"lanterns", {0.5f, 0.25f, 0.125f}}};
    light.light.groups = light.groups;
    light.light.other_groups = {7, 7, 7};
    const Moment moment(baked_yard().set(), light, {}, window);
    EXPECT_EQ(moment.factor_of(""), glm::vec3(1, 2, 3));
    EXPECT_EQ(moment.factor_of("lanterns"), glm::vec3(0.5f, 0.25f, 0.125f));
    EXPECT_EQ(moment.factor_of("huts"), glm::vec3(7));
}

TEST(TexelAge, FreshestIsWhatLiesAhead) {
    const auto light = morning();
    const glm::vec3 eye(60, 30, 2);
    const picture::TexelAge age(baked_yard().set(), *light, {}, eye, {1, 0, 0});
    int before = 64;
    // Half the window is 192 m, and the walk as long: what lies there was written with the last steps.
    for (float ahead_m = 2; ahead_m < 190; ahead_m += 4) {
        const int frames = age.frames_at(eye + glm::vec3(ahead_m, 0, 0));
        EXPECT_LE(frames, before);
        before = frames;
    }
    EXPECT_LE(before, 2);
    EXPECT_EQ(age.frames_at(eye - glm::vec3(100, 0, 0)), 64);
    // Outside of the volume there is no texel.
    EXPECT_EQ(age.frames_at(eye + glm::vec3(230, 0, 0)), 64);
    EXPECT_EQ(age.frames_at(eye + glm::vec3(180, 0, 60)), 64);
}

}  // namespace
}  // namespace drtv::test
