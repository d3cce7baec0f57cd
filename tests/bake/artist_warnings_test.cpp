// What a bake tells an artist of things that were hardly meant.
#include "bakerd/bake/sector_bake.h"
#include "tests/bake/worlds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace drtv::test {
namespace {

std::vector<std::string> warnings_of(const GltfBuilder& b) {
    settings::BakeSettings settings;
    settings.rays = 256;
    const auto baked = bake::bake_sector(*open_world(b), {0, 0}, settings);
    return baked.value().warnings;
}

std::size_t count_of(const std::vector<std::string>& warnings, const std::string& text) {
    return static_cast<std::size_t>(std::ranges::count_if(
        warnings, [&](const std::string& w) { return w.find(text) != std::string::npos; }));
}

int place_named(GltfBuilder& b, const Shape& shape, const std::string& name, bool double_sided = false) {
    const int grey = b.add_material({.colour = {0.5f, 0.5f, 0.5f, 1}, .double_sided = double_sided});
    return b.add_node({.mesh = b.add_mesh(shape, grey), .name = name});
}

// Ground of the sector (0, 0), in glTF's axes.
Shape floor_of_sector() {
    return quad({1, 0, -1}, {63, 0, -1}, {63, 0, -63}, {1, 0, -63});
}

Shape turned(Shape shape) {
    for (std::size_t t = 0; t < shape.indices.size(); t += 3)
        std::swap(shape.indices[t], shape.indices[t + 1]);
    return shape;
}

TEST(ClosedSky, DomeOrLidIsNamed) {
    // From below the ground to high above, and a flat lid.
    for (const Shape& sky : {turned(box({-200, -20, -264}, {264, 200, 200})), turned(ground(5000, 40))}) {
        GltfBuilder b;
        place_named(b, floor_of_sector(), "ground");
        place_named(b, sky, "sky dome");
        const auto warnings = warnings_of(b);
        EXPECT_EQ(count_of(warnings, "'sky dome'"), 1u);
        EXPECT_EQ(count_of(warnings, "sees the sky"), 1u);
    }
}

TEST(ClosedSky, RoomsAndOpenGroundNeedNoWord) {
    GltfBuilder rooms;
    place_named(rooms, room({1, 0, -63}, {63, 4, -1}), "hall");
    EXPECT_EQ(count_of(warnings_of(rooms), "sees the sky"), 0u);
    GltfBuilder open;
    place_named(open, floor_of_sector(), "ground");
    place_named(open, ground(15, 40), "cloud", true);
    EXPECT_EQ(count_of(warnings_of(open), "sees the sky"), 0u);
}

void add_lamp(GltfBuilder& b, const glm::dvec3& at,
              const Json& light = {{"type", "point"}, {"intensity", 100}}) {
    b.add_node({.light = b.add_light(light), .translation = at, .name = "lantern"});
}

TEST(EnclosedLamp, IsNamedWithWhatEnclosesIt) {
    for (const bool double_sided : {false, true}) {
        GltfBuilder b;
        place_named(b, floor_of_sector(), "ground");
        place_named(b, box({31.95f, 2.95f, -32.05f}, {32.05f, 3.05f, -31.95f}), "bulb", double_sided);
        add_lamp(b, {32, 3, -32});
        const auto warnings = warnings_of(b);
        EXPECT_EQ(count_of(warnings, "'lantern'"), 1u);
        EXPECT_EQ(count_of(warnings, "'bulb'"), 1u);
    }
}

TEST(EnclosedLamp, OpenShadeFlushCeilingAndRoomNeedNoWord) {
    GltfBuilder b;
    place_named(b, floor_of_sector(), "ground");
    // A shade open below, a lamp in the plane of a slab's lower side, a lamp in a small room.
    Shape shade = box({9.9f, 2.9f, -10.1f}, {10.1f, 3.1f, -9.9f});
    std::vector<std::uint32_t> sides;
    for (std::size_t t = 0; t < shade.indices.size(); t += 3) {
        const auto low = [&](std::size_t k) { return shade.positions[shade.indices[t + k]].y < 3; };
        if (!(low(0) && low(1) && low(2)))
            sides.insert(sides.end(), &shade.indices[t], &shade.indices[t] + 3);
    }
    shade.indices = sides;
    place_named(b, shade, "shade", true);
    add_lamp(b, {10, 3, -10});
    place_named(b, box({20, 3, -24}, {24, 3.2f, -20}), "slab");
    add_lamp(b, {22, 3, -22});
    place_named(b, room({30, 0, -31}, {31, 1, -30}), "closet", true);
    add_lamp(b, {30.5, 0.5, -30.5});
    EXPECT_EQ(count_of(warnings_of(b), "'lantern'"), 0u);
}

// A spot light shines one way only: what is behind it does not matter.
TEST(EnclosedLamp, SpotIsJudgedByItsCone) {
    const Json spot = {{"type", "spot"}, {"intensity", 100}, {"spot", {{"outerConeAngle", 0.5}}}};
    for (const bool open : {false, true}) {
        GltfBuilder b;
        place_named(b, floor_of_sector(), "ground");
        // It shines along glTF's -z, northwards; the housing has no front.
        Shape housing = box({31.9f, 2.9f, -32.1f}, {32.1f, 3.1f, -31.9f});
        std::vector<std::uint32_t> sides;
        for (std::size_t t = 0; t < housing.indices.size(); t += 3) {
            const auto north = [&](std::size_t k) {
                return housing.positions[housing.indices[t + k]].z < -32;
            };
            if (!open || !(north(0) && north(1) && north(2)))
                sides.insert(sides.end(), &housing.indices[t], &housing.indices[t] + 3);
        }
        housing.indices = sides;
        place_named(b, housing, "housing", true);
        add_lamp(b, {32, 3, -32}, spot);
        EXPECT_EQ(count_of(warnings_of(b), "'lantern'"), open ? 0u : 1u);
    }
}

}  // namespace
}  // namespace drtv::test
