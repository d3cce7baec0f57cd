// Materials and rays of the reference against answers known on paper.
#include "tests/reference/paper_answers.h"

#include "tests/reference/reference_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drtv::reference {
namespace {

// A sheet through which light goes sends `reflected` of the open sky up and `transmitted` of it down.
struct Sheet {
    const char* what;
    Surfacing surfacing;
    const char* role;
    std::array<double, channel_count> reflected, transmitted;
};

const Sheet sheets[] = {
    {"a plant's double-sided leaf",
     {.base_colour = colour_rgb, .double_sided = true},
     "vegetation",
     {0.5, 0.25, 0.95 * 2 / 3},
     {0.25, 0.125, 0.95 / 3}},
    {"a plant's masked leaf",
     {.base_colour = colour_rgb, .masked = true},
     "vegetation",
     {0.5, 0.25, 0.95 * 2 / 3},
     {0.25, 0.125, 0.95 / 3}},
    {"a plant's bark", {.base_colour = colour_rgb}, "vegetation", {0.5, 0.25, 0.9}, {0, 0, 0}},
    {"a double-sided cloth",
     {.base_colour = colour_rgb, .double_sided = true},
     "static",
     {0.5, 0.25, 0.9},
     {0, 0, 0}},
    {"a one-sided paper",
     {.base_colour = colour_rgb, .transmission = 0.25, .transmission_colour = {1, 0.4f, 0}},
     "static",
     {0.375, 0.1875, 0.675},
     {0.25, 0.1, 0}},
    {"a plant of paper",
     {.base_colour = colour_rgb,
      .double_sided = true,
      .transmission = 0.25,
      .transmission_colour = {1, 0.4f, 0}},
     "vegetation",
     {0.375, 0.1875, 0.675},
     {0.25, 0.1, 0}},
    {"a white paper",
     {.transmission = 0.5},
     "static",
     {0.95 * 0.475 / 0.975, 0.95 * 0.475 / 0.975, 0.95 * 0.475 / 0.975},
     {0.95 * 0.5 / 0.975, 0.95 * 0.5 / 0.975, 0.95 * 0.5 / 0.975}},
    {"a clear sheet",
     {.base_colour = colour_rgb, .transmission = 1, .transmission_colour = {1, 0.5f, 0.25f}},
     "static",
     {0, 0, 0},
     {0.95, 0.5, 0.25}},
};

TEST(ReferenceMaterial, SheetSendsLightBackAndThrough) {
    for (const Sheet& sheet : sheets) {
        SCOPED_TRACE(sheet.what);
        const map::Map map = one_patch(ground_patch(), sheet.surfacing, {}, sheet.role);
        const Scene scene(map);
        const Estimate over = integrate(scene, {0, 0, 1}, plane_options),
                       under = integrate(scene, {0, 0, -1}, plane_options);
        expect_transfer(over, uniform_transfer(ground_sends, half_space_share({0, 0, -1}), sheet.reflected),
                        float_input);
        expect_transfer(under, uniform_transfer(ground_sends, half_space_share({0, 0, 1}), sheet.transmitted),
                        float_input);
        expect_visibility(over, {1, 1, 1, 0}, exact_arithmetic);
        expect_visibility(under, {}, exact_arithmetic);
    }
}

TEST(ReferenceMaterial, ClearGlassLetsLightStraightThrough) {
    const glm::dvec3 colour(0.5, 0.25, 0.9);
    const Surfacing glass{.base_colour = colour_rgb, .clear = 0.75};
    const map::Map map = one_patch(ground_patch(), glass, {});
    const Scene scene(map);
    const Estimate over = integrate(scene, {0, 0, 1}, plane_options);
    const Estimate under = integrate(scene, {0, 0, -1}, plane_options);
    // What is not clear is sent back; seen from below, the sky has the glass's luminance.
    const double seen = 0.75 * glm::dot(colour, {0.2126, 0.7152, 0.0722});
    for (std::size_t b = 0; b < 3; ++b)
        EXPECT_NEAR(under.sky_visibility[b], seen, sigmas * under.visibility_error[b] + 1e-3);
    for (std::size_t c = 0; c < channel_count; ++c) {
        const double expected = 0.25 * colour[static_cast<glm::length_t>(c)] * ground_sends[0];
        EXPECT_NEAR(over.transfer[c][3][0], expected, sigmas * over.transfer_error[c][3][0] + float_input);
    }
}

TEST(ReferenceMaterial, TwoSheetsPassLightBetweenThem) {
    // Through both it takes two scatterings, and two more each time light goes back and forth: t^2 (1 + r^2 +
    // r^4 ...).
    GltfBuilder builder;
    const int mesh = builder.add_mesh(
        ground_patch(), builder.add_material({.base_colour = {0.6f, 0.3f, 0.4f, 1}, .double_sided = true}));
    for (const float height : {1.0f, 2.0f})
        builder.place(mesh, {.shift_m = {0, 0, height}}, "vegetation");
    const map::Map map = builder.import();
    const Scene scene(map);
    const auto sent = [](double r, int passes) {
        double sum = 0;
        for (int k = 0; k < passes; ++k)
            sum += r * r / 4 * std::pow(r, 2 * k);
        return sum;
    };
    // Only the first surface sees the sky's directions; what comes through is even, as from a sky of its
    // mean: 2 / 3 of the sky's Y2 counts, as for ground.
    for (const auto& [bounces, passes] : {std::pair{1u, 0}, {2u, 1}, {3u, 1}, {4u, 2}}) {
        Options options = plane_options;
        options.bounces = bounces;
        const Estimate under = integrate(scene, {0, 0, 0}, options);
        expect_transfer(under,
                        uniform_transfer(ground_sends, half_space_share({0, 0, 1}),
                                         {sent(0.6, passes), sent(0.3, passes), sent(0.4, passes)}),
                        float_input);
    }
}

TEST(ReferenceMaterial, BlendedSurfaceIsThereWithItsAlpha) {
    Patch ground = ground_patch();
    ground.colours.assign(4, {1, 1, 1, 0.5f});
    const map::Map map = one_patch(ground, {.base_colour = {0.5f, 0.25f, 0.9f, 0.6f}, .blended = true});
    const Scene scene(map);
    auto down = half_space_share({0, 0, -1});
    for (double& share : down)
        share *= 0.3;
    expect_transfer(integrate(scene, {0, 0, 1}, plane_options), uniform_transfer(ground_sends, down),
                    float_input);
    expect_visibility(integrate(scene, {0, 0, -1}, {}), {0.7, 0.7, 0.7, 0}, float_input);
}

// Small, large and long triangles all over the place.
Patch soup(Random& random) {
    Patch patch;
    for (std::uint32_t n = 0; n < 3000; ++n) {
        const auto point = [&](double size) {
            return glm::vec3(size * (random.next() - 0.5), size * (random.next() - 0.5),
                             size * (random.next() - 0.5));
        };
        const glm::vec3 corner = point(50) + glm::vec3(1000, -2000, 300),
                        long_edge = point(n % 50 == 0 ? 60 : 3);
        patch.positions.insert(patch.positions.end(), {corner, corner + long_edge, corner + point(2)});
        patch.triangles.emplace_back(3 * n, 3 * n + 1, 3 * n + 2);
    }
    return patch;
}

// By the planes of the triangle and of its three edges.
double distance_to(const std::array<glm::dvec3, 3>& t, const glm::dvec3& origin,
                   const glm::dvec3& direction) {
    const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double distance = glm::dot(t[0] - origin, normal) / glm::dot(direction, normal);
    const glm::dvec3 point = origin + distance * direction;
    bool inside = distance > 0;
    for (std::size_t k = 0; k < 3; ++k)
        inside = inside && glm::dot(glm::cross(t[(k + 1) % 3] - t[k], point - t[k]), normal) >= 0;
    return inside ? distance : std::numeric_limits<double>::infinity();
}

TEST(ReferenceScene, TreeFindsWhatAllTrianglesTogetherDo) {
    Random random(7);
    const map::Map map = one_patch(soup(random), {});
    const map::Primitive& primitive = map.meshes[0].primitives[0];
    const glm::dvec3 centre(1000, -2000, 300);
    const Scene scene(map), part(map, {centre - 30.0, centre + 5.0});
    EXPECT_EQ(scene.triangle_count(), 3000u);
    EXPECT_LT(part.triangle_count(), 1500u);
    int hits = 0;
    for (int n = 0; n < 3000; ++n) {
        const glm::dvec3 origin =
            centre + 40.0 * (glm::dvec3(random.next(), random.next(), random.next()) - 0.5);
        glm::dvec3 direction = sphere_direction(random.next(), random.next());
        if (n % 10 == 0)
            direction = glm::dvec3(n % 20 == 0 ? 1 : 0, 0, n % 20 == 0 ? 0 : -1);  // along an axis
        double nearest = std::numeric_limits<double>::infinity();
        for (const glm::uvec3& t : primitive.triangles) {
            const auto world = [&](std::uint32_t at) {
                return glm::dvec3(glm::dmat4x3(map.objects[0].world_from_object) *
                                  glm::dvec4(glm::dvec3(primitive.positions[at]), 1.0));
            };
            nearest = std::min(nearest, distance_to({world(t.x), world(t.y), world(t.z)}, origin, direction));
        }
        glm::dvec3 tint(1);
        const auto hit = scene.closest(origin, direction, random, tint);
        ASSERT_EQ(hit.has_value(), std::isfinite(nearest)) << n;
        if (!hit)
            continue;
        ++hits;
        ASSERT_NEAR(hit->distance_m, nearest, exact_arithmetic) << n;
        // Beyond what counts as the plane of the end.
        constexpr double beyond_m = 0.1;
        const auto hides = [&](const Scene& in, double far_m) {
            return in.arriving(origin, direction, far_m, random) == glm::dvec3(0);
        };
        const double cosine = std::abs(glm::dot(hit->normal, direction));
        EXPECT_TRUE(cosine < 0.1 || hides(scene, nearest + beyond_m));
        EXPECT_FALSE(hides(scene, nearest - 1e-6));
        const glm::dvec3 point = origin + nearest * direction;
        const bool kept =
            glm::all(glm::lessThan(point, centre + 5.0)) && glm::all(glm::greaterThan(point, centre - 30.0));
        EXPECT_TRUE(!kept || cosine < 0.1 || hides(part, nearest + beyond_m));
    }
    EXPECT_GT(hits, 500);
}

}  // namespace
}  // namespace drtv::reference
