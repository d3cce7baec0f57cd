// Surfaces in one plane, as kits are built: rooms of one-sided walls, wall on wall with their neighbours, and
// lamps in the plane of a ceiling or a wall.
#include "tests/bake/worlds.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <numbers>

namespace drtv::test {
namespace {

// Where a building stands: turned, and far enough that coordinates are coarse.
struct Site {
    std::string name;
    glm::dvec3 offset_m;  // glTF axes
    glm::dquat turn;
};

const std::vector<Site>& sites() {
    const glm::dquat straight(1, 0, 0, 0);
    const glm::dquat turned(glm::dvec3(0.3, 0.9, -0.1));
    static const std::vector<Site> all = {{"straight", {32, 0, -32}, straight},
                                          {"turned", {29.137, 3.3, -35.911}, turned},
                                          {"far", {3000.13, 20, -2011.7}, turned}};
    return all;
}

// A building, made in its own axes (glTF's).
class Building {
  public:
    explicit Building(const Site& site) : site_(site) {}

    void place(const Shape& shape, int material, const glm::dvec3& at = glm::dvec3(0)) {
        children_.push_back(builder.add_node({.mesh = builder.add_mesh(shape, material), .translation = at}));
    }
    void place_mesh(int mesh, const glm::dvec3& at) {
        children_.push_back(builder.add_node({.mesh = mesh, .translation = at}));
    }
    void lamp(const glm::dvec3& at, double candela) {
        const int light = builder.add_light({{"type", "point"}, {"intensity", candela}});
        children_.push_back(builder.add_node({.light = light, .translation = at}));
    }
    std::shared_ptr<bake::World> open() {
        const glm::dvec4 turn(site_.turn.x, site_.turn.y, site_.turn.z, site_.turn.w);
        builder.add_node({.translation = site_.offset_m, .rotation = turn, .children = children_});
        return open_world(builder);
    }
    [[nodiscard]] glm::vec3 in_world(const glm::dvec3& point) const {
        const glm::dvec3 p = site_.offset_m + site_.turn * point;
        return {p.x, -p.z, p.y};
    }

    GltfBuilder builder;

  private:
    const Site site_;
    std::vector<int> children_;
};

int plaster(GltfBuilder& b, bool double_sided = false, const glm::vec4& colour = {0.8f, 0.8f, 0.8f, 1}) {
    return b.add_material({.colour = colour, .double_sided = double_sided});
}

Shape joined(Shape a, const Shape& b) {
    const auto first = static_cast<std::uint32_t>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (const std::uint32_t index : b.indices)
        a.indices.push_back(first + index);
    return a;
}

// A room of 8 x 8 x 4 m without a ceiling, so that sky comes in. What touches it from outside is lower.
Shape open_room() {
    Shape shape = room({-4, 0, -4}, {4, 4, 4});
    std::vector<std::uint32_t> kept;
    for (std::size_t t = 0; t < shape.indices.size(); t += 3) {
        const auto height = [&](std::size_t k) { return shape.positions[shape.indices[t + k]].y; };
        if (height(0) < 4 || height(1) < 4 || height(2) < 4)
            kept.insert(kept.end(), &shape.indices[t], &shape.indices[t] + 3);
    }
    shape.indices = kept;
    return shape;
}

struct Side {
    glm::vec3 low, high;
};
constexpr std::array<Side, 4> neighbours = {Side{{4, 0, -6}, {15, 3.5f, 7}}, Side{{-12, 0, -5}, {-4, 4, 6}},
                                            Side{{-7, -1, 4}, {9, 3, 18}}, Side{{-6, 0, -15}, {7, 3.9f, -4}}};

enum class Kit { alone, instanced, different, one_mesh, double_sided };

bake::ProbeLight middle_of(Kit kit, const Site& site, const glm::dvec3& at) {
    Building building(site);
    const int walls = plaster(building.builder, kit == Kit::double_sided);
    // The neighbours' colour must not show.
    const int theirs = plaster(building.builder, kit == Kit::double_sided, {0.1f, 0.1f, 0.1f, 1});
    if (kit == Kit::one_mesh) {
        Shape all = open_room();
        for (const Side& side : neighbours)
            all = joined(all, room(side.low, side.high));
        building.place(all, walls);
    } else {
        building.place(open_room(), walls);
    }
    if (kit == Kit::instanced) {
        const int mesh = building.builder.add_mesh(room({-4, 0, -4}, {4, 4, 4}), theirs);
        for (const glm::dvec3& place : {glm::dvec3(8, 0, 0), {-8, 0, 0}, {0, 0, 8}, {0, 0, -8}})
            building.place_mesh(mesh, place);
    }
    if (kit == Kit::different || kit == Kit::double_sided) {
        for (const Side& side : neighbours)
            building.place(room(side.low, side.high), theirs);
    }
    building.lamp({0, 3, 0}, 6830);
    const auto world = building.open();
    return light_at(*world, building.in_world(at), 2048);
}

TEST(TouchingRooms, AreAsLightAsARoomAlone) {
    constexpr double same = 2e-3;  // a path near an edge may go another way
    const glm::dvec3 at(1.5, 1.25, -2);
    for (const Site& site : sites()) {
        const bake::ProbeLight alone = middle_of(Kit::alone, site, at);
        ASSERT_GT(under_constant_sky(alone, 1, 3), 0.05);
        for (const Kit kit : {Kit::instanced, Kit::different, Kit::one_mesh, Kit::double_sided}) {
            SCOPED_TRACE(site.name + ", kit " + std::to_string(static_cast<int>(kit)));
            const bake::ProbeLight light = middle_of(kit, site, at);
            EXPECT_EQ(light.back_hits, 0u);
            for (std::size_t b = 0; b < basis_count; ++b) {
                const double lit = static_cast<double>(alone.static_irradiance[1][b]);
                EXPECT_NEAR(light.static_irradiance[1][b], lit, same * lit);
                EXPECT_NEAR(under_constant_sky(light, 1, b), under_constant_sky(alone, 1, b), same);
                EXPECT_NEAR(light.sky_visibility[b], alone.sky_visibility[b], same);
            }
        }
    }
}

// Two one-sided skins, each there by chance: where one is met from behind, it is the other one's front.
TEST(TouchingRooms, SkinsOfABlendedThingHaveNoBack) {
    GltfBuilder b;
    b.place(ground(100), "", b.add_material({.colour = {0, 0, 0, 1}}));
    const int curtain = b.add_material({.colour = {0.5f, 0.5f, 0.5f, 0.5f}});
    b.json["materials"][static_cast<std::size_t>(curtain)]["alphaMode"] = "BLEND";
    Shape down = ground(2000, 3);
    for (std::size_t t = 0; t < down.indices.size(); t += 3)
        std::swap(down.indices[t], down.indices[t + 1]);
    b.place(joined(ground(2000, 3), down), "", curtain);
    const auto world = open_world(b);
    for (const float height_m : {1.0f, 5.0f})
        EXPECT_EQ(light_at(*world, {5, 6, height_m}, 2048).back_hits, 0u) << height_m;
}

// Behind a wall of thickness nothing changes: it still absorbs.
TEST(TouchingRooms, BackThatNoFrontCoversAbsorbs) {
    Building building(sites()[1]);
    const int walls = plaster(building.builder);
    building.place(room({-4, 0, -4}, {4, 4, 4}), walls);
    building.place(room({4.01f, 0, -4}, {12, 4, 4}), walls);
    building.lamp({0, 3, 0}, 6830);
    const auto world = building.open();
    const bake::ProbeLight between = light_at(*world, building.in_world({4.005, 2, 0}), 1024);
    EXPECT_GT(between.back_hits, 900u);
}

// Straight down from the lamp by the inverse square, elsewhere by the cosine too.
void expect_lit_by(const bake::ProbeLight& light, const glm::dvec3& to_lamp, double candela) {
    const double square = glm::dot(to_lamp, to_lamp);
    for (std::size_t b = 0; b < basis_count; ++b) {
        const glm::dvec3 axis(transfer_basis[b][0], transfer_basis[b][1], transfer_basis[b][2]);
        const double cosine = std::max(0.0, glm::dot(to_lamp, axis)) / std::sqrt(square);
        EXPECT_NEAR(light.static_irradiance[0][b], candela / 683 / square * cosine * std::numbers::inv_pi,
                    1e-3 * candela / 683 / square);
    }
}

// In the plane of a ceiling, in the edge of ceiling and wall, in a corner, and as near as rounding goes.
TEST(FlushLamp, LightsTheWholeRoom) {
    constexpr double candela = 6830;
    for (const Site& site : sites()) {
        for (const glm::dvec3& lamp :
             {glm::dvec3(0, 2, 0), {0, 2 - 1e-6, 0}, {4, 2, 1}, {-4, 2, 4}, {1, 0.5, -4}}) {
            for (const bool double_sided : {false, true}) {
                SCOPED_TRACE(site.name + " " + std::to_string(lamp.x) + " " + std::to_string(lamp.y));
                Building building(site);
                building.place(room({-4, -2, -4}, {4, 2, 4}),
                               plaster(building.builder, double_sided, {0, 0, 0, 1}));
                building.lamp(lamp, candela);
                const auto world = building.open();
                for (const glm::dvec3& probe :
                     {glm::dvec3(-3, 0, -3), {-1.5, 1.9, 0}, {0, -1.9, 0}, {1.5, 0, 3}, {3.9, 1, -3.9}}) {
                    const glm::vec3 at = building.in_world(probe);
                    // Where the probe stands, rounded to the grid of positions.
                    const glm::dvec3 stands = glm::round(glm::dvec3(at) * 1024.0) / 1024.0;
                    const glm::dvec3 to_lamp = glm::dvec3(building.in_world(lamp)) - stands;
                    expect_lit_by(light_at(*world, at, 64), to_lamp, candela);
                }
            }
        }
    }
}

// What is near the lamp but not in its plane hides it as ever.
TEST(FlushLamp, ShadeBeforeItHidesIt) {
    constexpr float below_m = 0.002f;
    Building building(sites()[0]);
    const int black = plaster(building.builder, true, {0, 0, 0, 1});
    building.place(room({-4, -2, -4}, {4, 2, 4}), black);
    building.place(quad({-0.1f, 2 - below_m, -0.1f}, {0.1f, 2 - below_m, -0.1f}, {0.1f, 2 - below_m, 0.1f},
                        {-0.1f, 2 - below_m, 0.1f}),
                   black);
    building.lamp({0, 2, 0}, 6830);
    const auto world = building.open();
    for (const glm::dvec3& probe : {glm::dvec3(-3, 0, -3), {0, -1.9, 0}, {1.5, 0, 3}}) {
        const bake::ProbeLight light = light_at(*world, building.in_world(probe), 64);
        for (const float value : light.static_irradiance[0])
            EXPECT_EQ(value, 0);
    }
}

// From behind, a one-sided sheet hides it, as it hides all else.
TEST(FlushLamp, DoesNotShineThroughTheBackOfASheet) {
    for (const Site& site : sites()) {
        for (const bool double_sided : {false, true}) {
            Building building(site);
            building.place(ground(30, -5), plaster(building.builder, false, {0, 0, 0, 1}));
            // A ceiling without anything above it, its front down.
            building.place(quad({-4, 2, -4}, {4, 2, -4}, {4, 2, 4}, {-4, 2, 4}),
                           plaster(building.builder, double_sided, {0, 0, 0, 1}));
            building.lamp({0.5, 2, 0.25}, 6830);
            const auto world = building.open();
            const auto sum = [&](const glm::dvec3& at) {
                double all = 0;
                const bake::ProbeLight light = light_at(*world, building.in_world(at), 64);
                for (const float value : light.static_irradiance[0])
                    all += static_cast<double>(value);
                return all;
            };
            for (const glm::dvec3& offset : {glm::dvec3(1, 1.5, 0), {-3, 0.5, 2}, {0.1, 1, 3}}) {
                EXPECT_GT(sum(glm::dvec3(0, 2, 0) - offset), 0) << site.name;
                EXPECT_EQ(sum(glm::dvec3(0, 2, 0) + offset) > 0, double_sided) << site.name;
            }
        }
    }
}

// In the plane of two walls that touch it stands in both rooms: nobody can tell which one it is meant for.
TEST(FlushLamp, InTouchingWallsLightsBothRooms) {
    for (const Site& site : sites()) {
        Building building(site);
        const int black = plaster(building.builder, false, {0, 0, 0, 1});
        building.place(room({-4, -2, -4}, {4, 2, 4}), black);
        building.place(room({4, -1.5f, -3}, {11, 2.5f, 5}), black);
        building.lamp({4, 0.5, 0.25}, 6830);
        const auto world = building.open();
        for (const double x : {1.0, 7.0}) {
            const glm::vec3 at = building.in_world({x, 0, 1});
            const glm::dvec3 stands = glm::round(glm::dvec3(at) * 1024.0) / 1024.0;
            expect_lit_by(light_at(*world, at, 64), glm::dvec3(building.in_world({4, 0.5, 0.25})) - stands,
                          6830);
        }
    }
}

// Lamps on the outer side of a wall stay outside.
TEST(FlushLamp, DoesNotShineThroughAWallOfThickness) {
    Building building(sites()[1]);
    const int grey = plaster(building.builder, true);
    building.place(room({-4, -2, -4}, {4, 2, 4}), grey);
    building.place(box({-4.2f, -2.2f, -4.2f}, {4.2f, 2.2f, 4.2f}), grey);
    building.lamp({4.2, 0, 0}, 6830);
    const auto world = building.open();
    const bake::ProbeLight light = light_at(*world, building.in_world({3, 0, 0}), 1024);
    for (const float value : light.static_irradiance[0])
        EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace drtv::test
