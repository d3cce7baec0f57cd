// Static lights against closed forms. In watts: glTF's candela and nits over 683.
#include "tests/bake/worlds.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace drtv::test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double lumens = 683;

// Of float sums of products of four numbers.
constexpr double rounding = 1e-5;

// Relative error of 8,192 paths on smooth one-bounce integrands, about four standard errors.
constexpr double sampling = 0.01;

Json point_light(double candela) {
    return {{"type", "point"}, {"intensity", candela}};
}

void add_light(GltfBuilder& b, const Json& light, const glm::vec3& world) {
    b.add_node({.light = b.add_light(light), .translation = glm::dvec3(gltf_from_world(world))});
}

int emissive_material(GltfBuilder& b, double albedo, double nits, bool double_sided = false) {
    const int material = b.add_material(
        {.colour = glm::vec4(glm::vec3(static_cast<float>(albedo)), 1), .double_sided = double_sided});
    auto& json = b.json["materials"][static_cast<std::size_t>(material)];
    json["emissiveFactor"] = {1, 1, 1};
    json["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = nits;
    return material;
}

// A ball with its fronts inwards, as a latitude-longitude grid.
Shape hollow_ball(float radius_m, int rings) {
    Shape shape;
    const int segments = 2 * rings;
    for (int r = 0; r <= rings; ++r) {
        for (int s = 0; s < segments; ++s) {
            const double theta = pi * r / rings, phi = 2 * pi * s / segments;
            shape.positions.emplace_back(radius_m * std::sin(theta) * std::cos(phi),
                                         radius_m * std::cos(theta),
                                         radius_m * std::sin(theta) * std::sin(phi));
        }
    }
    for (int r = 0; r < rings; ++r) {
        for (int s = 0; s < segments; ++s) {
            const auto a = static_cast<std::uint32_t>(r * segments + s),
                       c = static_cast<std::uint32_t>(r * segments + (s + 1) % segments),
                       n = static_cast<std::uint32_t>(segments);
            if (r > 0)
                shape.indices.insert(shape.indices.end(), {a, a + n, c});
            if (r + 1 < rings)
                shape.indices.insert(shape.indices.end(), {c, a + n, c + n});
        }
    }
    return shape;
}

double integral(const std::function<double(double)>& f, double from, double to, int steps = 20000) {
    double sum = 0;
    for (int n = 0; n < steps; ++n)
        sum += f(from + (to - from) * (n + 0.5) / steps);
    return sum * (to - from) / steps;
}

TEST(StaticLight, PointLightShinesByItsSquareDistanceAndTheCosine) {
    GltfBuilder b;
    b.place(ground(1), "", b.add_material({.colour = {0, 0, 0, 1}}));
    add_light(b, {{"type", "point"}, {"intensity", 1000}, {"color", {1, 0.5, 0}}}, {13, 4, 5});
    const auto world = open_world(b);
    const bake::ProbeLight light = light_at(*world, {10, 0, 5}, 64);
    for (std::size_t basis = 0; basis < basis_count; ++basis) {
        const double cosine = std::max(0.0, 0.6 * static_cast<double>(transfer_basis[basis][0]) +
                                                0.8 * static_cast<double>(transfer_basis[basis][1]));
        EXPECT_NEAR(light.static_irradiance[0][basis], 1000 / lumens / 25 * cosine / pi, rounding);
        EXPECT_NEAR(light.static_irradiance[1][basis], 500 / lumens / 25 * cosine / pi, rounding);
        EXPECT_EQ(light.static_irradiance[2][basis], 0);
    }
}

TEST(StaticLight, RangeAndConeAreTheExtensions) {
    const auto irradiance = [](const Json& source, const glm::dvec4& rotation) {
        GltfBuilder b;
        b.place(ground(1), "", b.add_material({.colour = {0, 0, 0, 1}}));
        b.add_node({.light = b.add_light(source),
                    .translation = glm::dvec3(gltf_from_world({30, 0, 1})),
                    .rotation = rotation});
        const auto world = open_world(b);
        return static_cast<double>(light_at(*world, {30, 0, 3}, 64).static_irradiance[0][3]) +
               static_cast<double>(light_at(*world, {30, 0, 3}, 64).static_irradiance[0][0]);
    };
    // Lamps below the probe shine up to direction 3 alone.
    const glm::dvec4 upright(std::sqrt(0.5), 0, 0, std::sqrt(0.5));  // -z of glTF turned to up
    const double plain = irradiance(point_light(100), upright);
    EXPECT_NEAR(plain, 100 / lumens / 4 / pi, rounding);
    EXPECT_NEAR(irradiance({{"type", "point"}, {"intensity", 100}, {"range", 4}}, upright),
                plain * (1 - 1.0 / 16), rounding);
    EXPECT_EQ(irradiance({{"type", "point"}, {"intensity", 100}, {"range", 1.9}}, upright), 0);
    const Json spot = {
        {"type", "spot"}, {"intensity", 100}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.6}}}};
    EXPECT_NEAR(irradiance(spot, upright), plain, rounding);
    const double tilt = 0.4, turned = pi / 2 - tilt;  // the probe stands 0.4 radians off the axis
    const double expected = (std::cos(tilt) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
    EXPECT_NEAR(irradiance(spot, {std::sin(turned / 2), 0, 0, std::cos(turned / 2)}),
                plain * expected * expected, rounding);
    EXPECT_EQ(irradiance(spot, {0, 0, 0, 1}), 0);
}

TEST(StaticLight, PlaneUnderALampSendsItBack) {
    constexpr double albedo = 0.6, lamp_m = 3, probe_m = 1.5, candela = 500;
    GltfBuilder b;
    b.place(ground(2000), "", b.add_material({.colour = {albedo, albedo, albedo, 1}}));
    add_light(b, point_light(candela), {20, 20, lamp_m});
    const auto world = open_world(b);
    const bake::ProbeLight light = light_at(*world, {20, 20, probe_m}, 8192);
    const double expected = integral(
        [&](double r) {
            const double to_lamp = r * r + lamp_m * lamp_m, to_probe = r * r + probe_m * probe_m;
            const double radiance = albedo / pi * candela / lumens * lamp_m / (to_lamp * std::sqrt(to_lamp));
            return radiance * probe_m * probe_m / (to_probe * to_probe) * 2 * r;  // 2 pi r dr, over pi
        },
        0, 400);
    EXPECT_NEAR(light.static_irradiance[0][3], expected, sampling * expected);
}

TEST(StaticLight, SunOnAPlane) {
    GltfBuilder b;
    b.place(ground(2000), "", b.add_material({.colour = {0.5, 0.25, 0, 1}}));
    // Shines straight down with 683 lux: 1 W/m2.
    b.add_node({.light = b.add_light({{"type", "directional"}, {"intensity", lumens}}),
                .rotation = glm::dvec4(-std::sqrt(0.5), 0, 0, std::sqrt(0.5))});
    const auto world = open_world(b);
    const bake::ProbeLight light = light_at(*world, {20, 20, 1}, 2048);
    EXPECT_NEAR(light.static_irradiance[0][3], 0.5 / pi,
                1e-4);  // what lies beyond the reach, as in exact_answers_test
    EXPECT_NEAR(light.static_irradiance[1][3], 0.25 / pi, 1e-4);
    // Direct by the cosine, and the part of the lobe that looks down.
    EXPECT_NEAR(light.static_irradiance[0][0], 0.577350 / pi + 0.5 / pi * (1 - 0.577350) / 2, 0.002);
}

// In a closed room whose walls all shine alike everything is equally bright, whatever its shape: the
// geometric series.
TEST(StaticLight, FurnaceIsTheGeometricSeries) {
    for (const double albedo : {0.0, 0.3, 0.7, 0.9}) {
        GltfBuilder b;
        b.place(room({-3, -1, -2}, {3, 2, 2}), "", emissive_material(b, albedo, 10 * lumens));
        const auto world = open_world(b);
        for (const std::uint32_t bounces : {0u, 1u, 3u, 8u}) {
            const bake::ProbeLight light = light_at(*world, {0.5f, 0.25f, 0.5f}, 4096, bounces);
            double series = 0;
            for (std::uint32_t k = 0; k <= bounces; ++k)
                series += 10 * std::pow(albedo, k);
            for (std::size_t basis = 0; basis < basis_count; ++basis)
                EXPECT_NEAR(light.static_irradiance[1][basis], series, 2 * sampling * series)
                    << albedo << " " << bounces;
        }
    }
}

TEST(StaticLight, BallWithALampInItsMiddle) {
    constexpr double albedo = 0.5, radius = 4, candela = 300;
    GltfBuilder b;
    b.place(hollow_ball(static_cast<float>(radius), 60), "",
            b.add_material({.colour = {albedo, albedo, albedo, 1}}));
    add_light(b, point_light(candela), {0, 0, 0});
    const auto world = open_world(b);
    const bake::ProbeLight light = light_at(*world, {1, -0.5f, 1.5f}, 8192, 3);
    const double wall = albedo / pi * candela / lumens / (radius * radius) * (1 + albedo + albedo * albedo);
    const glm::dvec3 to_lamp = -glm::dvec3(1, -0.5, 1.5);
    const double square = glm::dot(to_lamp, to_lamp);
    for (std::size_t basis = 0; basis < basis_count; ++basis) {
        const glm::dvec3 axis(transfer_basis[basis][0], transfer_basis[basis][1], transfer_basis[basis][2]);
        const double direct =
            candela / lumens / square * std::max(0.0, glm::dot(to_lamp, axis)) / std::sqrt(square) / pi;
        EXPECT_NEAR(light.static_irradiance[0][basis], direct + wall,
                    sampling * wall + rounding);  // facets are 0.1 % nearer than the ball
    }
}

// A square lamp overhead: the form factor of a parallel square on the axis of the probe.
TEST(StaticLight, SquareLampByItsFormFactor) {
    for (const double half : {0.05, 0.5, 5.0}) {
        GltfBuilder b;
        const auto h = static_cast<float>(half);
        b.place(quad({-h, 3, -h}, {-h, 3, h}, {h, 3, h}, {h, 3, -h}), "",
                emissive_material(b, 0, 1000 * lumens, true));
        const auto world = open_world(b);
        const bake::ProbeLight light =
            light_at(*world, {0, 0, 5}, 8192, 1);  // looked at from above, by direction 3
        const double x = half / 2,
                     factor = 1000 * 4 / pi * x / std::sqrt(1 + x * x) * std::atan(x / std::sqrt(1 + x * x));
        EXPECT_NEAR(light.static_irradiance[0][3], factor, sampling * factor) << half;
    }
}

// Far from the origin coordinates are coarse: a panel must not stand in the light that it sends to the floor.
TEST(StaticLight, PanelShinesTheSameFarFromTheOrigin) {
    const auto bounce_at = [](double offset_m) {
        GltfBuilder b;
        b.add_node({.mesh = b.add_mesh(ground(30), b.add_material({.colour = {0.8f, 0.8f, 0.8f, 1}})),
                    .translation = glm::dvec3(offset_m, 0, -offset_m)});
        b.add_node(
            {.mesh = b.add_mesh(quad({-0.3f, 3, -0.3f}, {0.3f, 3, -0.3f}, {0.3f, 3, 0.3f}, {-0.3f, 3, 0.3f}),
                                emissive_material(b, 0, 1000 * lumens)),
             .translation = glm::dvec3(offset_m, 0, -offset_m)});
        const auto world = open_world(b);
        const auto at = static_cast<float>(offset_m);
        return static_cast<double>(light_at(*world, {at, at, 1}, 8192, 1).static_irradiance[0][3]);
    };
    const double near = bounce_at(0), tolerance = 4 * sampling * near;
    EXPECT_GT(near, 1);
    EXPECT_NEAR(bounce_at(1000), near, tolerance);
    EXPECT_NEAR(bounce_at(4096), near, tolerance);
}

TEST(StaticLight, LampBehindAWallSendsNothingThrough) {
    GltfBuilder b;
    const int grey = b.add_material({.colour = {0.8f, 0.8f, 0.8f, 1}});
    b.place(room({-4, 0, -3}, {0, 3, 3}), "", grey);
    b.place(room({0.2f, 0, -3}, {4, 3, 3}), "", grey);
    add_light(b, point_light(10000), {-2, 0, 1.5f});
    const auto world = open_world(b);
    const double lit = static_cast<double>(light_at(*world, {-1, 0, 1}, 4096, 8).static_irradiance[0][0]);
    const bake::ProbeLight other = light_at(*world, {0.3f, 0, 1}, 4096, 8);
    EXPECT_GT(lit, 0.1);
    constexpr double leak = 0.001;  // of what the lit room has
    for (const float value : other.static_irradiance[0])
        EXPECT_LE(static_cast<double>(value), leak * lit);
}

TEST(StaticLight, MapWithoutLightsHasNone) {
    GltfBuilder b;
    b.place(ground(50), "", b.add_material({}));
    const auto world = open_world(b);
    const bake::ProbeLight light = light_at(*world, {1, 1, 1}, 256);
    EXPECT_EQ(light.static_irradiance, bake::BasisIrradiance{});
    EXPECT_EQ(light.shadow_rays, 0u);
}

// 10 W/sr from 5 m above: on the axis each cone lets all through, whatever it says of its angles.
TEST(StaticLight, SpotConesOfEveryKindAreWholeOnTheirAxis) {
    struct Case {
        const char* name;
        Json spot;
        double off_axis;  // at 30 degrees
    };
    const auto fall_off = [](double inner, double outer) {
        const double share = (std::cos(pi / 6) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
        return std::pow(std::clamp(share, 0.0, 1.0), 2);
    };
    const std::vector<Case> cases = {
        {"equal", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}, 0},
        {"right angle", {{"innerConeAngle", 0}, {"outerConeAngle", 1.5707963705062866}}, fall_off(0, pi / 2)},
        {"defaults", Json::object(), fall_off(0, pi / 4)},
        {"inner only", {{"innerConeAngle", 0.1}}, fall_off(0.1, pi / 4)}};
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        GltfBuilder b;
        b.place(ground(60), "", b.add_material({.colour = {0, 0, 0, 1}}));
        b.add_node({.light = b.add_light({{"type", "spot"}, {"intensity", 6830}, {"spot", c.spot}}),
                    .translation = glm::dvec3(32, 6.5, -32),
                    .rotation = glm::dvec4(-std::sin(pi / 4), 0, 0, std::cos(pi / 4))});
        const auto world = open_world(b);
        const bake::ProbeLight on_axis = light_at(*world, {32, 32, 1.5f}, 64);
        for (std::size_t basis = 0; basis < 3; ++basis)
            EXPECT_NEAR(on_axis.static_irradiance[0][basis], 10.0 / 25 * 0.57735 / pi, 1e-4);
        const double aside = 5 * std::tan(pi / 6), distance = std::hypot(5, aside);
        const bake::ProbeLight off_axis = light_at(*world, {32 + static_cast<float>(aside), 32, 1.5f}, 64);
        for (std::size_t basis = 0; basis < 3; ++basis) {
            const auto& axis = transfer_basis[basis];
            const double cosine =
                (-aside * static_cast<double>(axis[0]) + 5 * static_cast<double>(axis[2])) / distance;
            EXPECT_NEAR(off_axis.static_irradiance[0][basis],
                        10 / (distance * distance) * c.off_axis * std::max(0.0, cosine) / pi, 1e-4);
        }
    }
    GltfBuilder b;
    b.place(ground(60));
    b.add_node({.light = b.add_light({{"type", "spot"}, {"spot", {{"outerConeAngle", 1.6}}}})});
    EXPECT_NE(b.import().error().find("cone angles 0 and 1.6 do not lie one in the other and below pi/2"),
              std::string::npos);
}

// A box whose faces look inwards, and one of double-sided faces that look outwards, are the same room.
TEST(StaticLight, DoubleSidedWallsAreAsBrightAsOnesThatLookInwards) {
    const auto lit = [](bool inward) {
        GltfBuilder b;
        b.place(ground(60, -0.5f), "", b.add_material({.colour = {0.5f, 0.5f, 0.5f, 1}}));
        const int walls = b.add_material({.colour = {0.8f, 0.8f, 0.8f, 1}, .double_sided = !inward});
        const glm::vec3 low(28, 0, -36), high(36, 4, -28);
        b.place(inward ? room(low, high) : box(low, high), "", walls);
        add_light(b, point_light(300), {32, 32, 3});
        const auto world = open_world(b);
        std::vector<bake::BasisIrradiance> light;
        for (const float dx : {-2.0f, 0.0f, 2.0f}) {
            for (const float dy : {-2.0f, 0.0f, 2.0f})
                light.push_back(light_at(*world, {32 + dx, 32 + dy, 1.5f}, 4096).static_irradiance);
        }
        return light;
    };
    const auto inward = lit(true), double_sided = lit(false);
    double sum = 0, difference = 0;
    for (std::size_t p = 0; p < inward.size(); ++p) {
        for (std::size_t basis = 0; basis < basis_count; ++basis) {
            const float expected = inward[p][0][basis], found = double_sided[p][0][basis];
            EXPECT_GT(expected, 0.001f);
            EXPECT_NEAR(found, expected, 0.04f * expected) << p << " " << basis;
            sum += static_cast<double>(expected);
            difference += static_cast<double>(found - expected);
        }
    }
    EXPECT_NEAR(difference / sum, 0, 0.005);
}

}  // namespace
}  // namespace drtv::test
