// Clear glass (KHR_materials_transmission): light goes straight through it, in its colour.
#include "bakerd/bake/local_transfer.h"
#include "tests/bake/worlds.h"

#include <gtest/gtest.h>

#include <numbers>

namespace drtv::test {
namespace {

struct Glass {
    glm::vec3 colour{1};
    double factor = 1;
    double alpha = 1;
};

// What a probe sees through it.
double luminance(const glm::vec3& colour) {
    return 0.2126 * static_cast<double>(colour.x) + 0.7152 * static_cast<double>(colour.y) +
           0.0722 * static_cast<double>(colour.z);
}

int glass_material(GltfBuilder& b, const Glass& glass, bool double_sided = false) {
    const int material =
        b.add_material({.colour = glm::vec4(glass.colour, glass.alpha), .double_sided = double_sided});
    Json& json = b.json["materials"][static_cast<std::size_t>(material)];
    json["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = glass.factor;
    if (glass.alpha < 1)
        json["alphaMode"] = "BLEND";
    return material;
}

// A pane over the whole world, its front up.
void lay_pane(GltfBuilder& b, const Glass& glass, float height_m) {
    b.place(ground(2000, height_m), "", glass_material(b, glass));
}

const std::vector<Glass>& glasses() {
    static const std::vector<Glass> all = {{{1, 1, 1}, 1},
                                           {{1, 1, 1}, 0.5},
                                           {{0.9f, 0.5f, 0.1f}, 1},
                                           {{0.1f, 0.4f, 0.9f}, 0.6},
                                           {{0.9f, 0.5f, 0.1f}, 0.8, 0.5},
                                           {{0, 0, 0}, 1}};
    return all;
}

// The mean of 4,096 coins of the rarest glass here, four standard errors.
constexpr double sampling = 0.03;

// Where the sky is seen through a pane: its luminance, of each of a pane's two sides in turn.
TEST(ClearGlass, SkyIsSeenByLuminance) {
    for (const Glass& glass : glasses()) {
        GltfBuilder b;
        b.place(ground(2000), "", b.add_material({.colour = {0, 0, 0, 1}}));
        lay_pane(b, glass, 3);
        const auto world = open_world(b);
        const bake::ProbeLight light = light_at(*world, {5, 6, 1}, 4096);
        const double expected = (1 - glass.alpha) + glass.alpha * glass.factor * luminance(glass.colour);
        for (std::size_t basis = 0; basis < 3; ++basis)
            EXPECT_NEAR(light.sky_visibility[basis], expected, sampling);
    }
}

// A white floor below it: down through the pane, reflected, and seen without it.
TEST(ClearGlass, TransferTakesTheColour) {
    constexpr double floor_albedo = 0.8;
    for (const Glass& glass : glasses()) {
        GltfBuilder b;
        b.place(ground(2000), "", b.add_material({.colour = {floor_albedo, floor_albedo, floor_albedo, 1}}));
        lay_pane(b, glass, 3);
        const auto world = open_world(b);
        const bake::ProbeLight light = light_at(*world, {5, 6, 1}, 8192, 1);
        for (std::size_t c = 0; c < channel_count; ++c) {
            const double through =
                (1 - glass.alpha) +
                glass.alpha * glass.factor * static_cast<double>(glass.colour[static_cast<glm::length_t>(c)]);
            EXPECT_NEAR(under_constant_sky(light, c, 3), floor_albedo * through, sampling) << c;
        }
    }
}

// What does not go straight on is scattered, as far as the base colour sends it back.
TEST(ClearGlass, TheRestIsReflected) {
    for (const Glass& glass : glasses()) {
        GltfBuilder b;
        b.place(ground(2000), "", b.add_material({.colour = {0, 0, 0, 1}}));
        lay_pane(b, glass, 3);
        const auto world = open_world(b);
        const bake::ProbeLight light = light_at(*world, {5, 6, 4}, 8192, 1);
        for (std::size_t c = 0; c < channel_count; ++c) {
            const double reflected = glass.alpha * (1 - glass.factor) *
                                     static_cast<double>(glass.colour[static_cast<glm::length_t>(c)]);
            EXPECT_NEAR(under_constant_sky(light, c, 3), reflected, sampling) << c;
        }
    }
}

// One ray to each lamp must not come to all or nothing.
TEST(ClearGlass, LampBehindItShinesWithoutChance) {
    for (const Glass& glass : glasses()) {
        for (const int panes : {1, 2}) {
            GltfBuilder b;
            b.place(ground(20), "", b.add_material({.colour = {0, 0, 0, 1}}));
            for (int n = 0; n < panes; ++n)
                b.place(ground(20, 3 + 0.01f * static_cast<float>(n)), "", glass_material(b, glass));
            b.add_node({.light = b.add_light({{"type", "point"}, {"intensity", 683}}),
                        .translation = glm::dvec3(5, 5, -6)});
            const auto world = open_world(b);
            const bake::ProbeLight light = light_at(*world, {5, 6, 1}, 64, 0);
            for (std::size_t c = 0; c < channel_count; ++c) {
                const double once =
                    (1 - glass.alpha) + glass.alpha * glass.factor *
                                            static_cast<double>(glass.colour[static_cast<glm::length_t>(c)]);
                const double open = std::numbers::inv_pi / 16 * 0.577350;
                EXPECT_NEAR(light.static_irradiance[c][0], open * (panes == 2 ? once * once : once), 1e-5);
            }
        }
    }
}

// By way of a floor: half of the way to the lamp is behind the pane.
TEST(ClearGlass, BouncedLightOfALampTakesTheColour) {
    const Glass glass{{0.9f, 0.5f, 0.1f}, 0.9};
    const auto bounced = [](const Glass* pane) {
        GltfBuilder b;
        b.place(ground(2000), "", b.add_material({.colour = {0.8f, 0.8f, 0.8f, 1}}));
        if (pane != nullptr)
            lay_pane(b, *pane, 3);
        b.add_node({.light = b.add_light({{"type", "point"}, {"intensity", 6830}}),
                    .translation = glm::dvec3(5, 5, -6)});
        return light_at(*open_world(b), {5, 6, 1}, 16384, 1);
    };
    const bake::ProbeLight open = bounced(nullptr);
    const bake::ProbeLight behind = bounced(&glass);
    for (std::size_t c = 0; c < channel_count; ++c) {
        const double through =
            glass.factor * static_cast<double>(glass.colour[static_cast<glm::length_t>(c)]);
        const double expected = static_cast<double>(open.static_irradiance[c][3]) * through;
        EXPECT_NEAR(behind.static_irradiance[c][3], expected, 0.1 * expected + 1e-4);
    }
}

// Down through the pane, back up through it: of a lamp at the probe's own place too.
TEST(ClearGlass, LocalTransferPassesItTwice) {
    const Glass glass{{0.9f, 0.6f, 0.3f}, 1};  // sends nothing back by itself
    const auto local = [](const Glass* pane) {
        GltfBuilder b;
        b.place(ground(2000), "", b.add_material({.colour = {0.8f, 0.8f, 0.8f, 1}}));
        if (pane != nullptr)
            lay_pane(b, *pane, 0.5f);
        const auto world = open_world(b);
        const trace::FloatMode float_mode;
        const auto scene = world->scene_for({0, 0}, 512);
        const std::vector<glm::ivec3> places = {{20480, 20480, 1536}, {20480, 21504, 3072}};
        return bake::integrate_local(*scene, places, all_pairs(places.size()),
                                     *world->samples(16384, bake::local_sample_dimensions(1)), {1, 512});
    };
    const bake::LocalLight open = local(nullptr);
    const bake::LocalLight behind = local(&glass);
    for (std::size_t p = 0; p < 2; ++p) {
        for (std::size_t q = 0; q < 2; ++q) {
            for (std::size_t c = 0; c < channel_count; ++c) {
                const double once =
                    glass.factor * static_cast<double>(glass.colour[static_cast<glm::length_t>(c)]);
                const double expected = static_cast<double>(open.pairs[p][q][c][0]) * once * once;
                EXPECT_NEAR(behind.pairs[p][q][c][0], expected, 0.08 * expected) << p << q << c;
            }
        }
    }
}

// What no ray comes near must not matter.
TEST(ClearGlass, PaneFarAwayChangesNothing) {
    const auto local = [](bool with_pane) {
        GltfBuilder b;
        b.place(ground(200), "", b.add_material({.colour = {0.8f, 0.8f, 0.8f, 1}}));
        const int curtain = b.add_material({.colour = {0.5f, 0.5f, 0.5f, 0.5f}, .double_sided = true});
        b.json["materials"][static_cast<std::size_t>(curtain)]["alphaMode"] = "BLEND";
        b.place(ground(200, 0.5f), "", curtain);
        if (with_pane)
            b.place(quad({60, -9, 0}, {61, -9, 0}, {61, -8, 0}, {60, -8, 0}), "", glass_material(b, {}));
        const auto world = open_world(b);
        const trace::FloatMode float_mode;
        const auto scene = world->scene_for({0, 0}, 512);
        const std::vector<glm::ivec3> places = {{20480, 20480, 1536}, {20480, 21504, 3072}};
        return bake::integrate_local(*scene, places, all_pairs(places.size()),
                                     *world->samples(1024, bake::local_sample_dimensions(2)), {2, 512})
            .pairs;
    };
    EXPECT_EQ(local(false), local(true));
}

// A pane that glows does not colour its own light on the way out.
TEST(ClearGlass, GlowingPaneIsNotItsOwnFilter) {
    const auto lit = [](const glm::vec3& colour) {
        GltfBuilder b;
        b.place(ground(200), "", b.add_material({.colour = {0.8f, 0.8f, 0.8f, 1}}));
        const int pane = glass_material(b, {colour, 0.5}, true);
        Json& json = b.json["materials"][static_cast<std::size_t>(pane)];
        json["emissiveFactor"] = {1, 1, 1};
        json["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 683000;
        b.place(quad({-0.3f, 3, -0.3f}, {0.3f, 3, -0.3f}, {0.3f, 3, 0.3f}, {-0.3f, 3, 0.3f}), "", pane);
        return light_at(*open_world(b), {0.5f, 0.25f, 1}, 16384, 1).static_irradiance;
    };
    // As much of it is there in both: by the brightest channel.
    const auto white = lit({1, 1, 1}), red = lit({1, 0.1f, 0.1f});
    for (std::size_t c = 0; c < channel_count; ++c)
        EXPECT_NEAR(red[c][3], white[c][3], 0.05 * static_cast<double>(white[c][3])) << c;
}

// Straight through the diagonal of a square pane, along an axis: both triangles are met, and one pane.
TEST(ClearGlass, SharedEdgeIsOnePane) {
    GltfBuilder b;
    b.place(ground(20), "", b.add_material({.colour = {0, 0, 0, 1}}));
    b.place(quad({0, 3, -8}, {0, 3, 0}, {8, 3, 0}, {8, 3, -8}), "",
            glass_material(b, {{1, 1, 1}, 0.5}, true));
    b.add_node(
        {.light = b.add_light({{"type", "point"}, {"intensity", 683}}), .translation = glm::dvec3(4, 5, -4)});
    const auto world = open_world(b);
    EXPECT_NEAR(light_at(*world, {4, 4, 1}, 64, 0).static_irradiance[0][0],
                0.5 * std::numbers::inv_pi / 16 * 0.577350, 1e-5);
}

// Clear where the picture's red says so.
TEST(ClearGlass, PictureSaysWhereItIsClear) {
    GltfBuilder b;
    b.place(ground(2000), "", b.add_material({.colour = {0, 0, 0, 1}}));
    const int material = glass_material(b, {});
    const int picture = b.add_texture({.width = 2, .height = 1, .rgba = {51, 255, 255, 255, 51, 0, 0, 255}});
    b.json["materials"][static_cast<std::size_t>(material)]["extensions"]["KHR_materials_transmission"]
          ["transmissionTexture"]["index"] = picture;
    b.place(ground(2000, 3), "", material);
    const auto world = open_world(b);
    EXPECT_NEAR(light_at(*world, {5, 6, 1}, 4096).sky_visibility[1], 0.2, sampling);
}

// A window in a wall: as an opening of the same size, whichever way the pane looks.
TEST(ClearGlass, WindowIsAnOpening) {
    const auto seen = [](int kind) {
        GltfBuilder b;
        b.place(ground(2000), "", b.add_material({.colour = {0, 0, 0, 1}}));
        const int black = b.add_material({.colour = {0, 0, 0, 1}, .double_sided = true});
        b.place(quad({-2, 3, 2}, {2, 3, 2}, {2, 3, -2}, {-2, 3, -2}), "", black);
        b.place(quad({-2, 0, -2}, {-2, 0, 2}, {-2, 3, 2}, {-2, 3, -2}), "", black);
        b.place(quad({2, 0, 2}, {2, 0, -2}, {2, 3, -2}, {2, 3, 2}), "", black);
        b.place(quad({-2, 0, 2}, {2, 0, 2}, {2, 3, 2}, {-2, 3, 2}), "", black);
        const Shape pane = kind == 1 ? quad({-2, 0, -2}, {2, 0, -2}, {2, 3, -2}, {-2, 3, -2})
                                     : quad({2, 0, -2}, {-2, 0, -2}, {-2, 3, -2}, {2, 3, -2});
        if (kind > 0)
            b.place(pane, "", glass_material(b, {}));
        return light_at(*open_world(b), {0, 0, 1.5f}, 4096).sky_visibility;
    };
    const auto open = seen(0);
    EXPECT_EQ(seen(1), open);
    EXPECT_EQ(seen(2), open);
}

}  // namespace
}  // namespace drtv::test
