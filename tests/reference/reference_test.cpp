// Sky visibility and radiance transfer of the reference against answers known on paper.
#include "tests/reference/paper_answers.h"

#include <algorithm>
#include <cmath>

namespace drtv::reference {
namespace {

// Heights are limited to 8192 m, so that the wall is infinite only with a reach below that.
constexpr float wall_half_height_m = 8000;
constexpr double wall_reach_m = 7900;
constexpr double wall_rest = 1e-7;  // (1 m / 7.9 km)^2 and less

// The plane y = 0, front to -y.
Patch wall_patch() {
    Patch patch;
    patch.add_quad({-infinite_m, 0, -wall_half_height_m}, {infinite_m, 0, -wall_half_height_m},
                   {infinite_m, 0, wall_half_height_m}, {-infinite_m, 0, wall_half_height_m});
    return patch;
}

// A vertical wall with normal -y sees a quarter sphere: int of cos, cos^2 and cos z over it are pi / 2, pi /
// 3, 2 / 3.
constexpr Radiance wall_sends = {y0 / 2, -y1 / 3, y1 * 2 / (3 * pi), 0};

// int max(0, w.b) over {z > 0, w.other > 0} by Lambert's formula (1760): half the sum over the region's edges
// of the arc's length times (inward normal . b).
double two_plane_share(const glm::dvec3& other, const glm::dvec3& b) {
    const std::array<glm::dvec3, 3> inward = {glm::dvec3(0, 0, 1), other, b};
    std::array<glm::dvec3, 3> corner;  // corner[k] lies on the two planes that are not k
    for (std::size_t k = 0; k < 3; ++k) {
        corner[k] = glm::normalize(glm::cross(inward[(k + 1) % 3], inward[(k + 2) % 3]));
        if (glm::dot(corner[k], inward[k]) < 0)
            corner[k] = -corner[k];
    }
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
        sum += std::acos(glm::dot(corner[(k + 1) % 3], corner[(k + 2) % 3])) * glm::dot(inward[k], b) / 2;
    return sum;
}

TEST(Reference, EmptyWorldIsOpenSky) {
    const map::Map map;
    const Estimate estimate = integrate(Scene(map), {3, 4, 5}, {});
    expect_transfer(estimate, {}, 0);
    expect_visibility(estimate, {1, 1, 1, 0}, exact_arithmetic);
    EXPECT_EQ(estimate.sky_visibility[3], 0);
}

TEST(Reference, InfinitePlaneSendsBackItsAlbedo) {
    const map::Map map = one_patch(ground_patch(), {.base_colour = colour_rgb});
    const Estimate estimate = integrate(Scene(map), {0, 0, 1}, plane_options);
    expect_transfer(estimate, uniform_transfer(ground_sends, half_space_share({0, 0, -1})), float_input);
    expect_visibility(estimate, {1, 1, 1, 0}, exact_arithmetic);
    EXPECT_NEAR(estimate.transfer[0][3][0] * 3.5449, albedo_r, 0.004 * albedo_r);  // T[3] . sky = r
}

TEST(Reference, AlbedoIsFactorTimesVertexColourTimesTextureAtMost095) {
    const std::vector<std::uint8_t> grey = {188, 188, 188, 255};
    const double grey_linear = std::pow((188 / 255.0 + 0.055) / 1.055, 2.4);
    GltfBuilder builder;
    Patch patch = ground_patch();
    patch.colours.assign(4, {0.5f, 1, 1, 1});
    const int texture = builder.add_texture(encode_png(1, 1, grey));
    builder.place(builder.add_mesh(
                      patch, builder.add_material({.base_colour = {0.8f, 0.8f, 1, 1}, .texture = texture})),
                  {});
    const map::Map textured = builder.import();
    const auto down = half_space_share({0, 0, -1});
    expect_transfer(integrate(Scene(textured), {0, 0, 1}, plane_options),
                    uniform_transfer(ground_sends, down, {0.4 * grey_linear, 0.8 * grey_linear, grey_linear}),
                    float_input);

    const map::Map white = one_patch(ground_patch(), {});
    expect_transfer(integrate(Scene(white), {0, 0, 1}, plane_options),
                    uniform_transfer(ground_sends, down, {0.95, 0.95, 0.95}), float_input);
}

TEST(Reference, ReachIsASphereAroundTheProbeAtEveryBounce) {
    // 6 m over the ground a reach of 10 m leaves a disk: sin^2 of its half angle is 1 - 0.36.
    const Options options{.reach_m = 10};
    GltfBuilder builder;
    const int material = builder.add_material({.base_colour = colour_rgb, .double_sided = true});
    builder.place(builder.add_mesh(ground_patch(), material), {});
    const map::Map bare = builder.import();
    const Estimate disk = integrate(Scene(bare), {0, 0, 6}, options);
    for (std::size_t i = 0; i < sh_count; ++i)
        EXPECT_NEAR(disk.transfer[0][3][i], albedo_r * ground_sends[i] * 0.64,
                    sigmas * disk.transfer_error[0][3][i] + float_input);

    // A wall 11 m from the probe, 3 m from the disk's edge, is beyond the reach of later bounces too.
    builder.place(builder.add_mesh(wall_patch(), material), {.shift_m = {0, 11, 0}});
    const map::Map walled = builder.import();
    EXPECT_EQ(integrate(Scene(walled), {0, 0, 6}, options).transfer, disk.transfer);
    EXPECT_NE(integrate(Scene(walled), {0, 0, 6}, {.reach_m = 12}).transfer,
              integrate(Scene(bare), {0, 0, 6}, {.reach_m = 12}).transfer);
}

TEST(Reference, ClosedRoomIsBlackToTheLastBit) {
    Patch box;
    box.add_box({-3, -2, 0}, {4, 5, 3});
    for (const Placement& placement : {Placement{}, Placement{.scale = {-1, 1, 1}}}) {
        for (const bool double_sided : {false, true}) {
            const map::Map map = one_patch(box, {.double_sided = double_sided}, placement);
            const Estimate estimate = integrate(Scene(map), {0.3, 0.2, 1.1}, {.bounces = 8});
            EXPECT_EQ(estimate.transfer, Transfer{});
            EXPECT_EQ(estimate.sky_visibility, Visibility{});
        }
    }
}

TEST(Reference, IntegratingSphereGathersEachBounce) {
    // From any point of a sphere, cosine-weighted directions meet its area evenly. With a hole at the top of
    // the share f, a wall point sees f of the sky and 1 - f of the wall: L_N = r f sum_{k < N} (r (1 - f))^k.
    constexpr int rings = 48, around = 96, hole_rings = 12;
    constexpr double facets = 0.002;  // flat facets of 3.75 degrees against the sphere, relative
    Patch sphere;
    const auto at = [](int ring, int step) {
        const double polar = pi * ring / rings, azimuth = 2 * pi * step / around;
        return glm::vec3(5 * std::sin(polar) * std::cos(azimuth), 5 * std::sin(polar) * std::sin(azimuth),
                         5 * std::cos(polar));
    };
    for (int ring = hole_rings; ring < rings; ++ring) {
        for (int step = 0; step < around; ++step)
            sphere.add_quad(at(ring + 1, step), at(ring, step), at(ring, step + 1), at(ring + 1, step + 1));
    }
    const map::Map map = one_patch(sphere, {.base_colour = colour_rgb});
    const Scene scene(map);
    const double f = (1 - std::cos(pi * hole_rings / rings)) / 2;
    for (const std::uint32_t bounces : {0u, 1u, 2u, 5u}) {
        const Estimate estimate =
            integrate(scene, {0, 0, 0}, {.bounces = bounces, .strata = 16, .continuation_strata = 5});
        for (std::size_t c = 0; c < channel_count; ++c) {
            double sent = 0;
            for (std::uint32_t k = 0; k < bounces; ++k)
                sent += albedo[c] * f * std::pow(albedo[c] * (1 - f), k);
            const double error = estimate.transfer_error[c][3][0];
            EXPECT_NEAR(estimate.transfer[c][3][0] / y0, sent, sigmas * error / y0 + facets * sent)
                << bounces << " bounces, channel " << c;
            EXPECT_LT(error, largest_transfer_error);
        }
    }
}

TEST(Reference, WallReflectsOnItsFrontAndBothSidesOnlyWhereItMay) {
    struct Case {
        const char* what;
        bool double_sided;
        const char* role;
        glm::vec3 scale;
        double turn_radians;
        bool reflects;
    };
    const Case cases[] = {
        {"front", false, "static", {1, 1, 1}, 0, true},
        {"back", false, "static", {1, 1, 1}, pi, false},
        {"back, double-sided", true, "static", {1, 1, 1}, pi, true},
        {"back, vegetation", false, "vegetation", {1, 1, 1}, pi, true},
        {"front, mirrored along the wall", false, "static", {-1, 1, 1}, 0, true},
        {"back, mirrored along the wall", false, "static", {-1, 1, 1}, pi, false},
        {"front, mirrored through the wall and turned", false, "static", {1, -1, 1}, pi, true},
        {"mirrored through the wall", false, "static", {1, -1, 1}, 0, false}};
    Visibility visibility{};
    for (std::size_t b = 0; b < 3; ++b)
        visibility[b] = two_plane_share({0, -1, 0}, basis[b]) / (pi * (1 + basis[b].z) / 2);
    EXPECT_NEAR(visibility[2], 0.5, exact_arithmetic);                  // by symmetry
    EXPECT_NEAR(visibility[0] + visibility[1], 1.0, exact_arithmetic);  // likewise
    for (const Case& c : cases) {
        SCOPED_TRACE(c.what);
        const map::Map map =
            one_patch(wall_patch(), {.base_colour = colour_rgb, .double_sided = c.double_sided},
                      {.turn_radians = c.turn_radians, .scale = c.scale}, c.role);
        const Estimate estimate = integrate(Scene(map), {0, -1, 2}, {.reach_m = wall_reach_m});
        expect_transfer(estimate,
                        c.reflects ? uniform_transfer(wall_sends, half_space_share({0, 1, 0})) : Transfer{},
                        float_input);
        expect_visibility(estimate, visibility, wall_rest);
    }
}

TEST(Reference, DiskOverheadHidesItsCap) {
    // A cap of half angle a around the zenith, wholly in front of b, holds pi b.z sin^2 a of b's cosine.
    constexpr int corners = 256;
    constexpr double polygon = 2e-4;  // 256 corners against the circle: 1e-4 of its area
    Patch disk;
    disk.positions.push_back({0, 0, 0});
    for (int n = 0; n < corners; ++n)
        disk.positions.emplace_back(3 * std::cos(2 * pi * n / corners), 3 * std::sin(2 * pi * n / corners),
                                    0);
    for (std::uint32_t n = 0; n < corners; ++n)
        disk.triangles.emplace_back(0, 1 + n, 1 + (n + 1) % corners);
    const map::Map map = one_patch(disk, {}, {.shift_m = {1, 2, 9}});
    const Estimate estimate = integrate(Scene(map), {1, 2, 4}, {});
    const double sin2 = 9.0 / (9 + 25), seen = 1 - 2 * basis[0].z * sin2 / (1 + basis[0].z);
    expect_visibility(estimate, {seen, seen, seen, 0}, polygon);
    expect_transfer(estimate, {}, 0);  // its back absorbs
}

TEST(Reference, MaskedSurfaceIsThereFromTheCutoffOn) {
    // Factor 0.5 times the vertices' 0.25 to 1 crosses the cutoff at y = 0 (no rounding): half the sky is
    // left, as beside a wall.
    Patch ceiling = ground_patch();
    ceiling.colours = {{1, 1, 1, 0.25f}, {1, 1, 1, 0.25f}, {1, 1, 1, 1}, {1, 1, 1, 1}};
    const map::Map map =
        one_patch(ceiling, {.base_colour = {1, 1, 1, 0.5f}, .masked = true, .alpha_cutoff = 0.3125},
                  {.shift_m = {0, 0, 1}});
    const Estimate half = integrate(Scene(map), {0, 0, 0}, plane_options);
    Visibility expected{};
    for (std::size_t b = 0; b < 3; ++b)
        expected[b] = two_plane_share({0, -1, 0}, basis[b]) / (pi * (1 + basis[b].z) / 2);
    expect_visibility(half, expected, float_input);
}

}  // namespace
}  // namespace drtv::reference
