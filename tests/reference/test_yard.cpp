#include "tests/reference/test_yard.h"

#include "tests/reference/gltf_builder.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace drtv::reference {
namespace {

using std::numbers::pi;

constexpr glm::ivec3 units(double x, double y, double z) {
    return {static_cast<int>(x * 1024), static_cast<int>(y * 1024), static_cast<int>(z * 1024)};
}

// Leaves: blobs of opaque green on clear texels, with soft edges, so that the cutoff falls between texels.
std::vector<std::uint8_t> leaf_png() {
    constexpr std::uint32_t size = 16;
    std::vector<std::uint8_t> rgba;
    for (std::uint32_t y = 0; y < size; ++y) {
        for (std::uint32_t x = 0; x < size; ++x) {
            const double wave = std::sin(x * pi / 4 + 0.4) * std::cos(y * pi / 4 - 0.3);
            const auto level = [](double v) {
                return static_cast<std::uint8_t>(std::lround(255 * std::min(1.0, std::max(0.0, v))));
            };
            rgba.insert(rgba.end(),
                        {level(0.35 + 0.02 * x), level(0.6 + 0.02 * y), level(0.25), level(0.6 + wave)});
        }
    }
    return encode_png(size, size, rgba);
}

// A trunk and three tiers of crossed leaf cards.
void add_trees(GltfBuilder& builder) {
    const int bark = builder.add_material({.base_colour = {0.30f, 0.20f, 0.12f, 1}});
    const int leaves = builder.add_material({.base_colour = {1, 1, 1, 0.9f},
                                             .masked = true,
                                             .alpha_cutoff = 0.45,
                                             .texture = builder.add_texture(leaf_png())});
    Patch trunk, cards;
    trunk.add_box({-0.2f, -0.2f, -0.1f}, {0.2f, 0.2f, 3.5f});
    for (int tier = 0; tier < 3; ++tier) {
        const float radius = 2.2f - 0.5f * static_cast<float>(tier),
                    z = 2.0f + 1.2f * static_cast<float>(tier);
        for (int card = 0; card < 4; ++card) {
            const double angle = pi / 4 * card + 0.2 * tier;
            const glm::vec3 along(radius * std::cos(angle), radius * std::sin(angle), 0);
            const glm::vec3 lean(-0.4 * std::sin(angle), 0.4 * std::cos(angle), 1.3);
            cards.add_quad(-along + glm::vec3(0, 0, z), along + glm::vec3(0, 0, z),
                           along + lean + glm::vec3(0, 0, z), -along + lean + glm::vec3(0, 0, z));
        }
        cards.add_quad({-radius, -radius, z + 0.3f}, {radius, -radius, z + 0.5f}, {radius, radius, z + 0.3f},
                       {-radius, radius, z + 0.5f});
    }
    const std::vector<Patch> patches = {trunk, cards};
    const std::vector<int> materials = {bark, leaves};
    const int tree = builder.add_mesh(patches, materials);
    for (int n = 0; n < 5; ++n) {
        const float side = n % 2 == 0 ? 1.0f : -1.0f;  // every other one mirrored
        builder.place(tree,
                      {.shift_m = {14.0f + 8.5f * static_cast<float>(n), 47.0f + 2.0f * side, 0},
                       .turn_radians = 0.7 * n,
                       .scale = {side, 1, 0.9f + 0.1f * static_cast<float>(n)}},
                      "vegetation");
    }
    std::vector<Placement> grove;
    for (int n = 0; n < 5; ++n) {
        const float x = 40.0f + 5.0f * static_cast<float>(n % 3),
                    y = 12.0f + 6.0f * static_cast<float>(n / 3);
        grove.push_back(
            {.shift_m = {x, y, 0}, .turn_radians = 1.1 * n, .scale = {1.2f, n == 3 ? -1.2f : 1.2f, 1.1f}});
    }
    builder.place_instances(tree, grove, "vegetation");
}

}  // namespace

map::Map make_yard() {
    GltfBuilder builder;
    // Ground 60 x 60 m, brighter to the east by its vertex colours.
    Patch ground;
    ground.add_quad({2, 2, 0}, {62, 2, 0}, {62, 62, 0}, {2, 62, 0});
    ground.colours = {{0.6f, 0.7f, 0.5f, 1}, {1, 1, 1, 1}, {1, 0.9f, 0.8f, 1}, {0.5f, 0.6f, 0.6f, 1}};
    builder.place(builder.add_mesh(ground, builder.add_material({.base_colour = {0.5f, 0.45f, 0.35f, 1}})),
                  {});

    // A red and a blue wall meet in a corner at (10, 10), a white one stands in the east; all are solid.
    Patch red, blue, white;
    red.add_box({9.6f, 9.6f, -0.2f}, {26, 10, 5});
    blue.add_box({9.6f, 10, -0.2f}, {10, 27, 5});
    white.add_box({60, 18, -0.2f}, {60.4f, 44, 6});
    builder.place(builder.add_mesh(red, builder.add_material({.base_colour = {0.85f, 0.25f, 0.2f, 1}})), {});
    builder.place(builder.add_mesh(blue, builder.add_material({.base_colour = {0.15f, 0.3f, 0.9f, 1}})), {});

    builder.place(builder.add_mesh(white, builder.add_material({.base_colour = {0.8f, 0.8f, 0.75f, 1}})), {});

    // A one-sided screen with an L-shaped plan (front to -y, and to +x at its end), also mirrored and as an
    // instance.
    Patch screen;
    screen.add_quad({0, 0, 0}, {6, 0, 0}, {6, 0, 3.5f}, {0, 0, 3.5f});
    screen.add_quad({6, 0, 0}, {6, 2.5f, 0}, {6, 2.5f, 2}, {6, 0, 2});
    const int screen_mesh =
        builder.add_mesh(screen, builder.add_material({.base_colour = {0.9f, 0.8f, 0.3f, 1}}));
    builder.place(screen_mesh, {.shift_m = {30, 30, 0}});
    builder.place(screen_mesh, {.shift_m = {28, 36, 0}, .turn_radians = 0.5, .scale = {-1, 1, 1}});
    const std::vector<Placement> instances = {
        {.shift_m = {50, 32, 0}, .turn_radians = 2.0},
        {.shift_m = {44, 38, 0}, .turn_radians = -0.6, .scale = {1.3f, -1, 1.2f}}};
    builder.place_instances(screen_mesh, instances);

    // A double-sided sail and a bright roof on four posts.
    Patch sail, roof, posts;
    sail.add_quad({54, 20, 0.5f}, {58, 26, 0.5f}, {57, 27, 4}, {53, 21, 4});
    roof.add_box({12, 28, 3}, {20, 36, 3.3f});
    for (const float x : {12.3f, 19.5f}) {
        for (const float y : {28.3f, 35.5f})
            posts.add_box({x, y, -0.1f}, {x + 0.2f, y + 0.2f, 3});
    }
    builder.place(builder.add_mesh(sail, builder.add_material(
                                             {.base_colour = {0.7f, 0.7f, 0.9f, 1}, .double_sided = true})),
                  {});
    builder.place(builder.add_mesh(roof, builder.add_material({.base_colour = {1, 0.97f, 0.8f, 1}})),
                  {});  // clamps to 0.95
    builder.place(builder.add_mesh(posts, builder.add_material({.base_colour = {0.4f, 0.4f, 0.4f, 1}})), {});
    add_trees(builder);
    return builder.import();
}

std::span<const YardProbe> yard_probes() {
    static constexpr YardProbe probes[] = {
        {"in the corner of red and blue", units(11, 11, 1)},
        {"beside the red wall", units(18, 10.75, 1.5)},
        {"behind the red wall", units(20, 9, 1.25)},
        {"beside the blue wall", units(10.5, 19, 2)},
        {"under the roof", units(16, 32, 1.5)},
        {"at the roof's edge", units(20.5, 34, 2.5)},
        {"before the one-sided screen", units(33, 29, 1.5)},
        {"behind the one-sided screen", units(33, 31, 1.5)},
        {"before the mirrored screen", units(26, 33, 1.5)},
        {"under a tree", units(31.5, 49.5, 1.5)},
        {"in the grove", units(42.5, 15, 1.5)},
        {"inside leaves", units(45.5, 12.5, 3.75)},
        {"beside the sail", units(55, 24, 1.5)},
        {"between mirrored instances", units(46, 35, 1.5)},
        {"beside the white wall", units(58.5, 38, 1.5)},
    };
    return probes;
}

}  // namespace drtv::reference
