// Static irradiance of the reference against answers known on paper.
#include "tests/reference/paper_answers.h"

#include "tests/reference/reference_light.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace drtv::reference {
namespace {

constexpr double float_light = 1e-6;  // intensities, places and directions come in as floats; relative
constexpr double quadrature =
    1e-4;  // of the midpoint sums below, relative: a tenth of the noise they are held against
constexpr Options direct_only{.bounces = 0, .reach_m = 100, .batches = 2, .strata = 2};
const glm::dvec3 lamp_watts(1, 2, 0.5);

// Shines lamp_watts, W/sr or W/m2.
Lamp lamp(const std::string& type) {
    return {.type = type, .colour = {0.5f, 1, 0.25f}, .intensity = 2 * 683};
}

// A patch that no ray here meets: a map needs something.
Patch speck() {
    Patch patch;
    patch.add_quad({-60, -60, -60}, {-59.9f, -60, -60}, {-59.9f, -59.9f, -60}, {-60, -59.9f, -60});
    return patch;
}

map::Map lit(const Lamp& light, const Patch& patch = speck(), const Surfacing& surfacing = {},
             const std::string& role = "static") {
    GltfBuilder builder;
    builder.place(builder.add_mesh(patch, builder.add_material(surfacing)), {}, role);
    builder.place_lamp(light);
    return builder.import();
}

// E/pi around each basis direction of light from `towards` that brings `irradiance`.
Irradiance from_direction(const glm::dvec3& towards, const glm::dvec3& irradiance) {
    Irradiance result{};
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b)
            result[c][b] =
                irradiance[static_cast<glm::length_t>(c)] * std::max(0.0, glm::dot(towards, basis[b])) / pi;
    }
    return result;
}

void expect_static(const Estimate& estimate, const Irradiance& expected, double relative,
                   double largest_error = 0.01) {
    for (std::size_t c = 0; c < channel_count; ++c) {
        const double scale = *std::max_element(expected[c].begin(), expected[c].end());
        for (std::size_t b = 0; b < basis_count; ++b) {
            const double error = estimate.static_error[c][b];
            EXPECT_NEAR(estimate.static_irradiance[c][b], expected[c][b], sigmas * error + relative * scale)
                << "channel " << c << ", basis " << b;
            EXPECT_LE(error, largest_error * scale) << "channel " << c << ", basis " << b;
        }
    }
}

void expect_direct(const map::Map& map, const glm::dvec3& probe, const Irradiance& expected,
                   double reach_m = 100) {
    Options options = direct_only;
    options.reach_m = reach_m;
    expect_static(integrate(Scene(map), probe, options), expected, float_light, 0);
}

// The mean of `value` over the hemisphere z > 0, times 2 pi.
template <class Value, class Function>
Value over_hemisphere(Function value) {
    constexpr int rings = 600, around = 600;
    Value sum{};
    for (int ring = 0; ring < rings; ++ring) {
        for (int step = 0; step < around; ++step) {
            const double z = (ring + 0.5) / rings, r = std::sqrt(1 - z * z),
                         angle = 2 * pi * (step + 0.5) / around;
            value(glm::dvec3(r * std::cos(angle), r * std::sin(angle), z), 2 * pi / (rings * around), sum);
        }
    }
    return sum;
}

TEST(ReferenceLight, PointLightFallsWithTheSquareOfItsDistance) {
    Lamp light = lamp("point");
    light.position = {2, -1, 2};
    const glm::dvec3 towards = glm::normalize(glm::dvec3(2, -1, 2));
    expect_direct(lit(light), {0, 0, 0}, from_direction(towards, lamp_watts / 9.0));
    expect_direct(lit(light), {-2, 1, -2}, from_direction(towards, lamp_watts / 36.0));
    expect_direct(lit(light), {2, -1, 2.001},
                  from_direction({0, 0, -1}, lamp_watts / 1e-4));  // no nearer than 1 cm
    expect_direct(lit(light), {0, 0, 0}, {}, 2.9);                 // beyond the reach
    light.range_m = 6;
    expect_direct(lit(light), {0, 0, 0}, from_direction(towards, lamp_watts / 9.0 * (1 - 0.0625)));
    light.range_m = 3;
    expect_direct(lit(light), {0, 0, 0}, {});
}

TEST(ReferenceLight, SpotFadesBetweenItsCones) {
    Lamp light = lamp("spot");
    light.position = {0, 0, 4};
    light.direction = {1, 0, 0};
    light.inner_cone_radians = 0.4;
    light.outer_cone_radians = 0.8;
    for (const double angle : {0.0, 0.35, 0.6, 0.75, 0.85, 3.0}) {
        const double share =
            angle < 0.4   ? 1
            : angle > 0.8 ? 0
                          : std::pow((std::cos(angle) - std::cos(0.8)) / (std::cos(0.4) - std::cos(0.8)), 2);
        const glm::dvec3 away(std::cos(angle), std::sin(angle) * 0.6, std::sin(angle) * 0.8);
        expect_direct(lit(light), glm::dvec3(0, 0, 4) + 2.0 * away,
                      from_direction(-away, lamp_watts / 4.0 * share));
    }
}

TEST(ReferenceLight, DirectionalLightIsShadowedWithinReachOnly) {
    Lamp light = lamp("directional");
    light.direction = {0.6f, 0, -0.8f};
    const Irradiance open = from_direction({-0.6, 0, 0.8}, lamp_watts);
    Patch roof;
    roof.add_quad({-20, -20, 4}, {20, -20, 4}, {20, 20, 4}, {-20, 20, 4});
    expect_direct(lit(light), {0, 0, 0}, open);
    expect_direct(lit(light, roof), {0, 0, 0}, {}, 5.01);
    expect_direct(lit(light, roof), {0, 0, 0}, open, 4.99);
}

TEST(ReferenceLight, BlendedRoofLetsThroughWhatItsAlphaLacks) {
    Lamp light = lamp("point");
    light.position = {3, 0, 4};  // not over the roof's diagonal: there, both triangles draw
    Patch roof;
    roof.add_quad({-20, -20, 2}, {20, -20, 2}, {20, 20, 2}, {-20, 20, 2});
    const map::Map map = lit(light, roof, {.base_colour = {1, 1, 1, 0.25f}, .blended = true});
    expect_static(integrate(Scene(map), {0, 0, 0}, {.bounces = 0}),
                  from_direction({0.6, 0, 0.8}, lamp_watts / 25.0 * 0.75), float_light, 0.02);
}

// A point light over an infinite sheet, and a probe over or under it: what the sheet scatters, by quadrature.
TEST(ReferenceLight, PlaneScattersAPointLightToBothSides) {
    Lamp light = lamp("point");
    light.position = {2, 1, 3};
    const glm::dvec3 at(2, 1, 3);
    const map::Map map =
        lit(light, ground_patch(),
            {.base_colour = colour_rgb, .transmission = 0.25, .transmission_colour = {1, 0.4f, 0}});
    for (const glm::dvec3& probe : {glm::dvec3(0, 0, 1.5), glm::dvec3(1, 0, -1.5)}) {
        const bool over = probe.z > 0;
        const glm::dvec3 share =
            over ? glm::dvec3(albedo_r, albedo_g, albedo_b) * 0.75 : glm::dvec3(1, 0.4, 0) * 0.25;
        Irradiance expected =
            over ? from_direction(glm::normalize(at - probe), lamp_watts / glm::dot(at - probe, at - probe))
                 : Irradiance{};
        const auto bounced = over_hemisphere<Irradiance>([&](const glm::dvec3& up, double solid_angle,
                                                             Irradiance& sum) {
            const glm::dvec3 w(up.x, up.y, over ? -up.z : up.z), to_light = at - (probe + w * (1.5 / up.z));
            const glm::dvec3 radiance = share / pi * lamp_watts * at.z / std::pow(glm::length(to_light), 3);
            for (std::size_t c = 0; c < channel_count; ++c) {
                for (std::size_t b = 0; b < basis_count; ++b)
                    sum[c][b] += solid_angle / pi * std::max(0.0, glm::dot(w, basis[b])) *
                                 radiance[static_cast<glm::length_t>(c)];
            }
        });
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t b = 0; b < basis_count; ++b)
                expected[c][b] += bounced[c][b];
        }
        expect_static(integrate(Scene(map), probe, {.reach_m = 5e4}), expected, quadrature, 0.004);
    }
}

TEST(ReferenceLight, GlowingRoomAddsUpItsBounces) {
    // Walls of radiance L that send back r: the room's is L (1 + r + ... + r^N) from everywhere.
    Patch box;
    box.add_box({-3, -2, 0}, {4, 5, 3});
    const map::Map map = one_patch(box, {.base_colour = colour_rgb,
                                         .double_sided = true,
                                         .emission = {1, 0.5f, 0.25f},
                                         .emission_strength = 683});
    const glm::dvec3 emission(1, 0.5, 0.25);
    for (const std::uint32_t bounces : {0u, 1u, 4u}) {
        Irradiance expected{};
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::uint32_t k = 0; k <= bounces; ++k) {
                for (double& around : expected[c])
                    around += emission[static_cast<glm::length_t>(c)] * std::pow(albedo[c], k);
            }
        }
        expect_static(integrate(Scene(map), {0.3, 0.2, 1.1},
                                {.bounces = bounces, .strata = 32, .continuation_strata = 2}),
                      expected, float_light, 0.004);
    }
}

TEST(ReferenceLight, GlowingQuadIsSeenFromItsFront) {
    struct Case {
        const char* what;
        double height_m;
        bool double_sided;
        const char* role;
        bool seen;
    };
    const Case cases[] = {{"front", 1.5, false, "static", true},
                          {"back", -1.5, false, "static", false},
                          {"back, double-sided", -1.5, true, "static", true},
                          {"back, vegetation", -1.5, false, "vegetation", false}};
    const std::vector<std::uint8_t> grey = {188, 255, 255, 255};
    const glm::dvec3 radiance(std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), 0.5, 0.25);
    Patch quad;
    quad.add_quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
    for (const Case& c : cases) {
        SCOPED_TRACE(c.what);
        GltfBuilder builder;
        const int picture = builder.add_texture(encode_png(1, 1, grey));
        const Surfacing surfacing{.double_sided = c.double_sided,
                                  .emission = {1, 0.5f, 0.25f},
                                  .emission_strength = 683,
                                  .emission_texture = picture};
        builder.place(builder.add_mesh(quad, builder.add_material(surfacing)), {}, c.role);
        const map::Map map = builder.import();
        const glm::dvec3 probe(0.3, 0.2, c.height_m);
        Irradiance expected{};
        constexpr int side = 400;
        for (int n = 0; c.seen && n < side * side; ++n) {
            const glm::dvec3 way =
                glm::dvec3((n % side + 0.5) * 2 / side - 1, (n / side + 0.5) * 2 / side - 1, 0) - probe;
            const double area = 4.0 / (side * side), distance2 = glm::dot(way, way),
                         solid_angle = area * std::abs(way.z) / std::pow(distance2, 1.5);
            for (std::size_t k = 0; k < channel_count; ++k) {
                for (std::size_t b = 0; b < basis_count; ++b)
                    expected[k][b] += radiance[static_cast<glm::length_t>(k)] * solid_angle / pi *
                                      std::max(0.0, glm::dot(way, basis[b])) / std::sqrt(distance2);
            }
        }
        expect_static(integrate(Scene(map), probe, {.bounces = 2}), expected, quadrature, 0.01);
    }
}

}  // namespace
}  // namespace drtv::reference
