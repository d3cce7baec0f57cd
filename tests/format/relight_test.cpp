// relight() and shade_ambient() against the talk's code (s27-s29, s40-s44), written again in double.
#include <drtv/relight.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace drtv {
namespace {

// Sums of a dozen floats around 1.
constexpr double float_tolerance = 2e-5;
// Fixed-point codes of transfer are good to 0.25 / 32767, and the sky's first coefficient is 3.5.
constexpr double code_tolerance = 6e-5;

using Double3 = std::array<double, 3>;
using Double4 = std::array<double, 4>;

// const float3 Basis_0 = float3( -0.408248, -0.707107, 0.5773503 ); and so on.
constexpr std::array<Double3, 4> seed_basis = {{{-0.408248, -0.707107, 0.5773503},
                                                {-0.408248, 0.707107, 0.5773503},
                                                {0.816497, 0, 0.5773503},
                                                {0, 0, -1}}};

Double4 seed_sh(const Double3& w) {
    return {0.282095, 0.488603 * w[1], 0.488603 * w[2], 0.488603 * w[0]};
}

double seed_dot(const Double4& a, const Float4& b) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
        sum += a[i] * static_cast<double>(b[i]);
    return sum;
}

std::array<Double3, 4> seed_relight(const Probe& probe, const DistantLight& sky, const DistantLight& sun) {
    std::array<Double3, 4> colour{};
    for (std::size_t b = 0; b < 4; ++b) {
        for (std::size_t c = 0; c < 3; ++c) {
            Double4 transfer;
            for (std::size_t i = 0; i < 4; ++i)
                transfer[i] = probe.transfer[c][b][i] / 32767.0 * 0.5;
            colour[b][c] = seed_dot(transfer, sky[c]);
            colour[b][c] += seed_dot(transfer, sun[c]);
            colour[b][c] += seed_dot(seed_sh(seed_basis[b]), sky[c]) * (probe.sky_visibility[b] / 32767.0);
        }
    }
    return colour;
}

Double3 seed_shade(const BasisColours& colours, const Float3& normal) {
    Double4 weights;
    for (std::size_t b = 0; b < 4; ++b) {
        weights[b] = 0;
        for (std::size_t k = 0; k < 3; ++k)
            weights[b] += static_cast<double>(normal[k]) * seed_basis[b][k];
    }
    constexpr Double4 scale = {1, 1, 1, 0.5}, bias = {0, 0, 0, 0.5};
    for (std::size_t b = 0; b < 4; ++b)
        weights[b] = weights[b] * scale[b] + bias[b];
    for (std::size_t b = 0; b < 3; ++b)
        weights[b] *= std::min(1.0, std::max(0.0, weights[b]));
    Double3 ambient{};
    for (std::size_t b = 0; b < 4; ++b) {
        for (std::size_t c = 0; c < 3; ++c)
            ambient[c] += weights[b] * static_cast<double>(colours[b][c]);
    }
    return ambient;
}

class RandomLight {
  public:
    float between(float low, float high) {
        return low + (high - low) * static_cast<float>(engine_() % 65536) / 65536;
    }
    DistantLight light() {
        DistantLight light{};
        for (Float4& channel : light) {
            for (float& y : channel)
                y = between(-2, 2);
        }
        return light;
    }
    Float3 direction() {
        for (;;) {
            const Float3 w = {between(-1, 1), between(-1, 1), between(-1, 1)};
            const float square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
            if (square > 1 || square < 0.01f)
                continue;
            const float length = std::sqrt(square);
            return {w[0] / length, w[1] / length, w[2] / length};
        }
    }
    Probe probe() {
        Probe probe;
        for (auto& channel : probe.transfer) {
            for (auto& row : channel) {
                for (std::int16_t& q : row)
                    q = static_cast<std::int16_t>(engine_() % 65535 - 32767);
            }
        }
        for (std::size_t b = 0; b < 3; ++b)
            probe.sky_visibility[b] = static_cast<std::int16_t>(engine_() % 32768);
        return probe;
    }

  private:
    std::mt19937 engine_{11};
};

TEST(Relight, AgreesWithTheTalksCodeInDouble) {
    RandomLight random;
    for (int n = 0; n < 300; ++n) {
        const Probe probe = random.probe();
        const DistantLight sky = random.light(), sun = random.light();
        const BasisColours colours = relight(probe, sky, sun);
        const auto expected = seed_relight(probe, sky, sun);
        for (std::size_t b = 0; b < 4; ++b) {
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_NEAR(colours[b][c], expected[b][c], float_tolerance);
        }
    }
}

TEST(Relight, SunMakesNoDirectLight) {
    Probe open;
    open.sky_visibility = {32767, 32767, 32767, 0};
    const BasisColours colours = relight(open, {}, directional_sun({5, 5, 5}, {0, 0, 1}));
    EXPECT_EQ(colours, BasisColours{});
}

TEST(Relight, StaticIrradianceIsAddedToWhatIsThere) {
    const StaticIrradiance light = {{{{32767, 0, 16384, 1}, {0, 32767, 0, 0}, {0, 0, 0, 32767}}}, 3};
    BasisColours colours{};
    colours[2] = {1, 2, 3};
    add_static_irradiance(colours, light);
    const BasisColours expected = {
        {{8, 0, 0}, {0, 8, 0}, {1 + 8 * (16384 / 32767.0f), 2, 3}, {8 * (1 / 32767.0f), 0, 8}}};
    EXPECT_EQ(colours, expected);
}

TEST(Relight, ConstantSkyIsTheVectorOfTheExactAnswers) {
    const DistantLight sky = constant_sky({1, 2, 4});
    EXPECT_NEAR(sky[0][0], 3.5449, 1e-4);
    EXPECT_NEAR(sky[1][0], 2 * 3.5449, 2e-4);
    for (const Float4& channel : sky)
        EXPECT_EQ(channel[1] + channel[2] + channel[3], 0);
}

TEST(Relight, OpenSkyOfOneGivesOneUpwardAndNothingDown) {
    Probe open;
    open.sky_visibility = {32767, 32767, 32767, 0};
    const BasisColours colours = relight(open, constant_sky({1, 1, 1}), {});
    for (std::size_t b = 0; b < 3; ++b)
        EXPECT_NEAR(colours[b][0], 1, float_tolerance);
    EXPECT_EQ(colours[3][0], 0);
}

TEST(Relight, PlaneOfAlbedoRSendsRDownwards) {
    Probe probe;
    probe.transfer[0][3][0] = encode_fixed(0.3f * sh_y0, transfer_scale);
    EXPECT_NEAR(relight(probe, constant_sky({1, 1, 1}), {})[3][0], 0.3, code_tolerance);
}

TEST(Relight, SunIsItsIrradianceTimesSh) {
    const DistantLight sun = directional_sun({1, 2, 3}, {0.6f, 0, 0.8f});
    EXPECT_NEAR(sun[1][0], 2 * 0.282095, float_tolerance);
    EXPECT_EQ(sun[1][1], 0);
    EXPECT_NEAR(sun[1][2], 2 * 0.488603 * 0.8, float_tolerance);
    EXPECT_NEAR(sun[2][3], 3 * 0.488603 * 0.6, float_tolerance);
}

// One channel, band 0 and the z of band 1, at scale 4.
TEST(ShadeLocal, IsIntensityTimesTheSumOverTheHarmonics) {
    const LightCodes pair = {{{16384, 0, 8192, 0}, {0, 0, 0, 0}, {0, 32767, 0, 0}}};
    const Float3 up = shade_local(pair, 4, {2, 3, 5}, {0, 0, 1}),
                 north = shade_local(pair, 4, {2, 3, 5}, {0, 1, 0});
    EXPECT_NEAR(up[0], 2 * (2.0 * 0.282095 + 1.0 * 0.488603), 2e-4);
    EXPECT_EQ(up[1], 0);
    EXPECT_EQ(up[2], 0);
    EXPECT_NEAR(north[0], 2 * 2.0 * 0.282095, 2e-4);
    EXPECT_NEAR(north[2], 5 * 4 * 0.488603, 2e-4);
}

// Of light that all comes from above: 0.2821 R0 at the side, as much below 0 at the opposite normal.
TEST(ShadeLocal, TwoBandsGoBelowZeroAndStayLinear) {
    const auto code = [](double value) { return static_cast<std::int16_t>(value * 16384); };
    const LightCodes from_above = {{{code(1), 0, code(1.1547), 0}, {}, {}}};
    const LightCodes from_below = {{{code(1), 0, code(-1.1547), 0}, {}, {}}};
    const LightCodes from_both = {{{code(1), 0, 0, 0}, {}, {}}};
    const auto red = [](const LightCodes& pair, const Float3& normal) {
        return shade_local(pair, 2, {1, 1, 1}, normal)[0];
    };
    EXPECT_NEAR(red(from_above, {0, 0, 1}), 3 * 0.282095, 1e-3);
    EXPECT_NEAR(red(from_above, {0, 0, -1}), -0.282095, 1e-3);
    for (const Float3& normal : {Float3{0, 0, 1}, {0, 0, -1}, {0.6f, 0, 0.8f}})
        EXPECT_NEAR(red(from_above, normal) + red(from_below, normal), 2 * red(from_both, normal), 1e-3);
}

TEST(ShadeAmbient, AgreesWithTheTalksCodeInDouble) {
    RandomLight random;
    for (int n = 0; n < 1000; ++n) {
        const BasisColours colours = relight(random.probe(), random.light(), random.light());
        const Float3 normal = random.direction();
        const Float3 ambient = shade_ambient(colours, normal);
        const Double3 expected = seed_shade(colours, normal);
        for (std::size_t c = 0; c < 3; ++c)
            ASSERT_NEAR(ambient[c], expected[c], float_tolerance);
    }
}

TEST(ShadeAmbient, NormalUpTakesAThirdOfEachUpwardColourAndNothingFromBelow) {
    const BasisColours colours = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {9, 9, 9}}};
    const Float3 ambient = shade_ambient(colours, {0, 0, 1});
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(ambient[c], 1.0 / 3, float_tolerance);
}

TEST(ShadeAmbient, NormalDownTakesAllOfTheLastColour) {
    const BasisColours colours = {{{9, 9, 9}, {9, 9, 9}, {9, 9, 9}, {1, 2, 3}}};
    EXPECT_EQ(shade_ambient(colours, {0, 0, -1}), (Float3{1, 2, 3}));
}

}  // namespace
}  // namespace drtv
