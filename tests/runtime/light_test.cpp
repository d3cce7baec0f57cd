// Sun and sky as harmonics against numbers by hand and integrals.
#include <drtv/light.h>
#include <drtv/relight.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace drtv {
namespace {

constexpr float pi = 3.14159265f;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

void expect_near(const Float4& found, const Float4& expected, double tolerance) {
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(found[i], expected[i], tolerance) << i;
}

float value(const Float4& coefficients, const Float3& w) {
    const Float4 y = evaluate_sh(w);
    return coefficients[0] * y[0] + coefficients[1] * y[1] + coefficients[2] * y[2] + coefficients[3] * y[3];
}

std::vector<Float3> upper_directions() {
    std::mt19937 engine(5);
    std::uniform_real_distribution<float> height(0.001f, 1), angle(0, 2 * pi);
    std::vector<Float3> directions;
    for (int n = 0; n < 500; ++n) {
        const float z = height(engine), r = std::sqrt(1 - z * z), a = angle(engine);
        directions.push_back({r * std::cos(a), r * std::sin(a), z});
    }
    return directions;
}

Float3 of_height(const Float3& w, void*) {
    return {1, w[2], 2 - w[2] + w[0]};
}

TEST(Light, SkiesByHand) {
    expect_near(constant_sky({1, 1, 1})[0], {3.5449f, 0, 0, 0}, 1e-4);
    const DistantLight fitted = fit_sky(of_height, nullptr);
    expect_near(fitted[0], {3.5449f, 0, 0, 0}, 1e-4);
    expect_near(fitted[1], {0, 0, 2.0467f, 0}, 1e-4);
    expect_near(fitted[2], {7.0898f, 0, -2.0467f, 2.0467f}, 2e-4);
}

TEST(Light, SunsByHand) {
    const Sun zenith{{pi, pi, pi}, {0, 0, 3}};
    expect_near(sun_as_sh(RelightMode::literal, zenith)[0], {0.8862f, 0, 1.5350f, 0}, 1e-4);
    expect_near(sun_as_sh(RelightMode::accurate, zenith)[0], {-3.5449f, 0, 6.1400f, 0}, 1e-4);
}

TEST(Light, NoSunBelowTheHorizonOrWithoutADirection) {
    for (const Float3& direction :
         {Float3{1, 0, 0}, {0, 0.5f, -0.1f}, {0, 0, 0}, {nan, 0, 1}, {0, 0, INFINITY}}) {
        for (const RelightMode mode : {RelightMode::literal, RelightMode::accurate})
            EXPECT_EQ(sun_as_sh(mode, {{1, 1, 1}, direction}), DistantLight{});
    }
}

// The fit keeps what a sun brings to any transfer that is a function of two bands over the upper hemisphere:
// the integral of the fit times Y_i there is E Y_i(w).
TEST(Light, FittedSunHasTheSunsMomentsOverTheUpperHemisphere) {
    const Float3 w = {0.48f, -0.36f, 0.8f};
    const Float4 fitted = sun_as_sh(RelightMode::accurate, {{1, 1, 1}, w})[0];
    std::array<double, 4> moments{};
    constexpr int slices = 400, steps = 400;
    for (int k = 0; k < slices; ++k) {
        const double z = (k + 0.5) / slices, r = std::sqrt(1 - z * z);
        for (int n = 0; n < steps; ++n) {
            const double angle = 2 * M_PI * n / steps;
            const Float3 v = {static_cast<float>(r * std::cos(angle)),
                              static_cast<float>(r * std::sin(angle)), static_cast<float>(z)};
            for (std::size_t i = 0; i < 4; ++i)
                moments[i] +=
                    static_cast<double>(value(fitted, v) * evaluate_sh(v)[i]) * 2 * M_PI / slices / steps;
        }
    }
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(moments[i], static_cast<double>(evaluate_sh(w)[i]), 1e-4) << i;
}

TEST(Light, GradientSkyIsItsFormulaAboveTheHorizon) {
    const SkyColours colours{{0.2f, 0.4f, 0.9f}, {0.5f, 0.6f, 0.7f}, {0.3f, 0.2f, 0.1f}};
    const DistantLight sky = gradient_sky(colours, {3, 4, 12});
    for (const Float3& w : upper_directions()) {
        for (std::size_t c = 0; c < 3; ++c) {
            const float side = 0.6f * w[0] + 0.8f * w[1];
            const float expected = colours.horizon[c] + (colours.zenith[c] - colours.horizon[c]) * w[2] +
                                   colours.sun_side[c] * (1 + side) / 2;
            ASSERT_NEAR(value(sky[c], w), expected, 1e-5);
        }
    }
}

TEST(Light, GradientSkyWithoutASideHasHalfOfItEverywhere) {
    const SkyColours colours{{}, {}, {1, 2, 4}};
    for (const Float3& to_sun : {Float3{0, 0, 1}, {0, 0, 0}, {nan, 1, 1}}) {
        const DistantLight sky = gradient_sky(colours, to_sun);
        expect_near(sky[1], {3.5449f, 0, 0, 0}, 1e-4);
    }
}

TEST(Light, SamplesOfTwoBandsAreFittedExactlyHoweverTheyLie) {
    const DistantLight sky =
        gradient_sky({{0.2f, 0.4f, 0.9f}, {0.5f, 0.6f, 0.7f}, {0.3f, 0.2f, 0.1f}}, {1, 0, 0});
    std::vector<SkySample> samples;
    std::mt19937 engine(6);
    for (const Float3& w : upper_directions()) {
        const bool rare = w[0] < 0 && engine() % 8 != 0;
        if (!rare)
            samples.push_back({w, {value(sky[0], w), value(sky[1], w), value(sky[2], w)}, w[2]});
    }
    samples.push_back({{0, 0, -1}, {99, 99, 99}, 1});
    samples.push_back({{0, nan, 1}, {99, 99, 99}, 1});
    samples.push_back({{0, 0, 1}, {INFINITY, 0, 0}, 1});
    samples.push_back({{0, 0, 1}, {9, 9, 9}, -1});
    const DistantLight fitted = fit_sky(samples);
    for (std::size_t c = 0; c < 3; ++c)
        expect_near(fitted[c], sky[c], 1e-5);
}

TEST(Light, FewSamplesGiveDefinedSkies) {
    EXPECT_EQ(fit_sky(std::span<const SkySample>{}), DistantLight{});
    const SkySample one{{0, 0, 1}, {1, 2, 3}, 1};
    const DistantLight sky = fit_sky({&one, 1});
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(value(sky[c], {0, 0, 1}), one.radiance[c], 1e-4);
}

// The closed form of what an open sky brings to a cosine, against its integral.
TEST(Light, OpenSkyIsTheIntegralOverTheUpperHemisphere) {
    std::mt19937 engine(7);
    std::uniform_real_distribution<float> coefficient(-1, 1);
    SceneLight light;
    for (Float4& channel : light.sky) {
        for (float& a : channel)
            a = coefficient(engine);
    }
    const BasisColours colours = open_sky(light);
    constexpr int slices = 1000, steps = 1000;
    for (std::size_t b = 0; b < 4; ++b) {
        double sum = 0;
        for (int k = 0; k < slices; ++k) {
            const double z = (k + 0.5) / slices, r = std::sqrt(1 - z * z);
            for (int n = 0; n < steps; ++n) {
                const double angle = 2 * M_PI * n / steps;
                const Float3 v = {static_cast<float>(r * std::cos(angle)),
                                  static_cast<float>(r * std::sin(angle)), static_cast<float>(z)};
                const float cosine =
                    v[0] * transfer_basis[b][0] + v[1] * transfer_basis[b][1] + v[2] * transfer_basis[b][2];
                sum +=
                    static_cast<double>(std::max(0.0f, cosine) * value(light.sky[0], v)) * 2 / slices / steps;
            }
        }
        EXPECT_NEAR(colours[b][0], sum, 1e-5) << b;
    }
}

}  // namespace
}  // namespace drtv
