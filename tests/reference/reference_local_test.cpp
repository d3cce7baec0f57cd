// Local transfer of the reference against answers known on paper.
#include "tests/reference/paper_answers.h"

#include "tests/reference/reference_local.h"

#include <algorithm>
#include <cmath>

namespace drtv::reference {
namespace {

constexpr double quadrature = 1e-4;  // of the midpoint sum, relative
constexpr std::array<double, sh_count> cosine_share = {1, 2.0 / 3, 2.0 / 3, 2.0 / 3};

void expect_local(const LocalEstimate& estimate, const LocalTransfer& expected, double relative,
                  double largest_error) {
    for (std::size_t c = 0; c < channel_count; ++c) {
        const double scale = std::abs(expected[c][0]);
        for (std::size_t i = 0; i < sh_count; ++i) {
            const double error = estimate.transfer_error[c][i];
            EXPECT_NEAR(estimate.transfer[c][i], expected[c][i], sigmas * error + relative * scale)
                << "channel " << c << ", SH " << i;
            EXPECT_LE(error, largest_error * scale) << "channel " << c << ", SH " << i;
        }
    }
}

TEST(ReferenceLocal, PlaneSendsBackItsLightByQuadrature) {
    const map::Map map = one_patch(ground_patch(), {.base_colour = colour_rgb});
    const glm::dvec3 receiver(0, 0, 2);
    const std::array<glm::dvec3, 4> sources = {
        glm::dvec3(1.5, 0.5, 1), {0, 0, 2}, {0.6, -0.4, 0.3}, {0, 0, 40}};
    const auto estimates = integrate_local(Scene(map), receiver, sources, {.bounces = 3, .reach_m = 5e4});
    for (std::size_t s = 0; s < sources.size(); ++s) {
        SCOPED_TRACE(s);
        LocalTransfer expected{};
        constexpr int rings = 1000, around = 1000;
        for (int ring = 0; ring < rings; ++ring) {
            for (int step = 0; step < around; ++step) {
                const double z = -(ring + 0.5) / rings, r = std::sqrt(1 - z * z),
                             angle = 2 * pi * (step + 0.5) / around;
                const glm::dvec3 w(r * std::cos(angle), r * std::sin(angle), z),
                    way = sources[s] - (receiver - w * (receiver.z / z));
                const double irradiance =
                    way.z / glm::length(way) /
                    std::max(glm::dot(way, way), 0.25);  // no brighter than at half a metre
                const std::array<double, sh_count> sh = {y0, y1 * w.y, y1 * w.z, y1 * w.x};
                for (std::size_t c = 0; c < channel_count; ++c) {
                    for (std::size_t i = 0; i < sh_count; ++i)
                        expected[c][i] +=
                            cosine_share[i] * 2 * pi / (rings * around) * albedo[c] / pi * irradiance * sh[i];
                }
            }
        }
        expect_local(estimates[s], expected, quadrature, 0.01);
    }
    const auto beyond =
        integrate_local(Scene(map), receiver, sources, {.reach_m = 37.9, .batches = 2, .strata = 8});
    EXPECT_EQ(beyond[3].transfer, LocalTransfer{});
    EXPECT_NE(beyond[0].transfer, LocalTransfer{});
}

TEST(ReferenceLocal, SphereGathersEachBounce) {
    // From its centre a light brings 1 / R^2 to a sphere's wall everywhere, so that the wall sends 1 / (pi
    // R^2) (r + ... + r^N), and any point inside has that from all sides.
    constexpr int rings = 48, around = 96;
    constexpr double facets = 0.004, radius = 5;  // flat facets of 3.75 degrees against the sphere, relative
    Patch sphere;
    const auto at = [](int ring, int step) {
        const double polar = pi * ring / rings, azimuth = 2 * pi * step / around;
        return glm::vec3(radius * std::sin(polar) * std::cos(azimuth),
                         radius * std::sin(polar) * std::sin(azimuth), radius * std::cos(polar));
    };
    for (int ring = 0; ring < rings; ++ring) {
        for (int step = 0; step < around; ++step)
            sphere.add_quad(at(ring + 1, step), at(ring, step), at(ring, step + 1), at(ring + 1, step + 1));
    }
    const map::Map map = one_patch(sphere, {.base_colour = colour_rgb});
    const Scene scene(map);
    const std::array<glm::dvec3, 1> centre = {glm::dvec3(0)};
    for (const std::uint32_t bounces : {1u, 2u, 4u}) {
        LocalTransfer expected{};
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::uint32_t k = 1; k <= bounces; ++k)
                expected[c][0] += 4 * pi * y0 * std::pow(albedo[c], k) / (pi * radius * radius);
        }
        expect_local(integrate_local(scene, {1, -2, 0.5}, centre, {.bounces = bounces, .strata = 32})[0],
                     expected, facets, 0.01);
    }
}

TEST(ReferenceLocal, SheetLightsBothSidesByTransmission) {
    // A light and a receiver 2 m apart on a line across an infinite sheet see the same of it, whichever side
    // it is on.
    const map::Map map = one_patch(
        ground_patch(), {.base_colour = {0.4f, 0.4f, 0.4f, 1}, .double_sided = true}, {}, "vegetation");
    const Scene scene(map);
    const std::array<glm::dvec3, 2> sources = {glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)};
    const auto estimates = integrate_local(scene, {0, 0, 1}, sources, {.reach_m = 5e4});
    // Receiver and light at height 1: L = r / pi cos^3, E/pi's Y0 is y0 times the integral of L: y0 r / pi 2
    // pi / 4.
    EXPECT_NEAR(estimates[0].transfer[0][0], y0 * 0.4 / 2,
                sigmas * estimates[0].transfer_error[0][0] + float_input);
    EXPECT_NEAR(estimates[1].transfer[0][0], y0 * 0.2 / 2,
                sigmas * estimates[1].transfer_error[0][0] + float_input);
    EXPECT_LT(estimates[1].transfer_error[0][0], 0.005 * estimates[1].transfer[0][0]);
}

}  // namespace
}  // namespace drtv::reference
