// Relighting and shading against the talk's code (slides 27 to 29, 40 to 44), written again in double; and
// what is exact in the accurate mode.
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

std::array<Double3, 4> seed_relight(const Probe& probe, const SceneLight& light) {
    const DistantLight& sky = light.sky;
    const DistantLight sun = sun_as_sh(RelightMode::literal, light.sun);
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

BasisColours relit(const Probe& probe, const SceneLight& light) {
    return relight(probe.transfer, probe.sky_visibility, light);
}

SceneLight white_sky(RelightMode mode = RelightMode::accurate) {
    return {.mode = mode, .sky = constant_sky({1, 1, 1})};
}

class RandomLight {
  public:
    float between(float low, float high) {
        return low + (high - low) * static_cast<float>(engine_() % 65536) / 65536;
    }
    SceneLight light(RelightMode mode) {
        SceneLight light{.mode = mode};
        for (Float4& channel : light.sky) {
            for (float& y : channel)
                y = between(-2, 2);
        }
        light.sun = {{between(0, 4), between(0, 4), between(0, 4)}, direction()};
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
        const SceneLight light = random.light(RelightMode::literal);
        const BasisColours colours = relit(probe, light);
        const auto expected = seed_relight(probe, light);
        for (std::size_t b = 0; b < 4; ++b) {
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_NEAR(colours[b][c], expected[b][c], float_tolerance);
        }
    }
}

TEST(Relight, SunMakesNoDirectLight) {
    Probe open;
    open.sky_visibility = {32767, 32767, 32767, 0};
    for (const RelightMode mode : {RelightMode::literal, RelightMode::accurate}) {
        const SceneLight light{.mode = mode, .sun = {{5, 5, 5}, {0, 0, 1}}};
        EXPECT_EQ(relit(open, light), BasisColours{});
    }
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

// Over a plane of albedo r: T[b] = s r (Y0, 0, 2/3 Y1, 0), where s is the share that b sends down.
Probe over_plane(double albedo) {
    Probe probe;
    probe.sky_visibility = {32767, 32767, 32767, 0};
    for (auto& channel : probe.transfer) {
        for (std::size_t b = 0; b < 4; ++b) {
            const double down = albedo * (1 - static_cast<double>(transfer_basis[b][2])) / 2;
            channel[b][0] = encode_fixed(static_cast<float>(down * 0.282095), transfer_scale);
            channel[b][2] = encode_fixed(static_cast<float>(down * 0.325735), transfer_scale);
        }
    }
    return probe;
}

TEST(Relight, OpenSkyOfOneIsOneUpwardInTheTalksCodeAndTheOpenShareInTruth) {
    Probe open;
    open.sky_visibility = {32767, 32767, 32767, 0};
    const BasisColours literal = relit(open, white_sky(RelightMode::literal));
    const BasisColours accurate = relit(open, white_sky());
    for (std::size_t b = 0; b < 3; ++b) {
        EXPECT_NEAR(literal[b][0], 1, float_tolerance);
        EXPECT_NEAR(accurate[b][0], 0.788675, float_tolerance);
    }
    EXPECT_EQ(literal[3][0], 0);
    EXPECT_EQ(accurate[3][0], 0);
    EXPECT_EQ(accurate, open_sky(white_sky()));
}

TEST(Relight, PlaneOfAlbedoRSendsRDownwards) {
    for (const RelightMode mode : {RelightMode::literal, RelightMode::accurate})
        EXPECT_NEAR(relit(over_plane(0.3), white_sky(mode))[3][0], 0.3, code_tolerance);
}

// The bounce of a sun over flat ground of albedo r: in truth r E sin(elevation) / pi.
TEST(Relight, SunOverFlatGroundByElevation) {
    constexpr double albedo = 0.4;
    constexpr float pi = 3.14159265f;
    struct Case {
        float degrees;
        double literal;
        double accurate;
    };
    for (const auto& [degrees, literal, accurate] : {Case{90, 0.75, 1}, {30, 0.5, 0.5}, {0.001f, 0.25, 0}}) {
        const float elevation = degrees / 180 * pi;
        const Sun sun{{pi, pi, pi}, {std::cos(elevation), 0, std::sin(elevation)}};
        const auto below = [&](RelightMode mode) {
            return relit(over_plane(albedo), {.mode = mode, .sun = sun})[3][1];
        };
        EXPECT_NEAR(below(RelightMode::literal), albedo * literal, 2 * code_tolerance) << degrees;
        EXPECT_NEAR(below(RelightMode::accurate), albedo * accurate, 6 * code_tolerance) << degrees;
    }
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
        const BasisColours colours = clamped(relit(random.probe(), random.light(RelightMode::literal)));
        const Float3 normal = random.direction();
        const Float3 ambient = shade_ambient(RelightMode::literal, colours, normal);
        const Double3 expected = seed_shade(colours, normal);
        for (std::size_t c = 0; c < 3; ++c)
            ASSERT_NEAR(ambient[c], std::max(0.0, expected[c]), float_tolerance);
    }
}

TEST(ShadeAmbient, WeightsByHand) {
    const auto near = [](const Float4& found, const Float4& expected) {
        for (std::size_t b = 0; b < 4; ++b)
            EXPECT_NEAR(found[b], expected[b], float_tolerance) << b;
    };
    constexpr auto literal = RelightMode::literal;
    near(basis_weights(literal, {1, 0, 0}), {0, 0, 2 / 3.0f, 0.5f});
    near(basis_weights(literal, {-1, 0, 0}), {1 / 6.0f, 1 / 6.0f, 0, 0.5f});
    near(basis_weights(literal, {0, 0, 1}), {1 / 3.0f, 1 / 3.0f, 1 / 3.0f, 0});
    near(basis_weights(literal, {0, 0, -1}), {0, 0, 0, 1});
    constexpr auto accurate = RelightMode::accurate;
    for (std::size_t b = 0; b < 4; ++b) {
        Float4 one{};
        one[b] = 1;
        near(basis_weights(accurate, transfer_basis[b]), one);
    }
    near(basis_weights(accurate, {0, 0, 1}), {0.422650f, 0.422650f, 0.422650f, -0.267949f});
}

// E/pi of any light of two bands is c0 + c.n. Four of its values give it back at every normal.
TEST(ShadeAmbient, AccurateIsExactForTwoBands) {
    RandomLight random;
    for (int n = 0; n < 1000; ++n) {
        const Float3 slope = random.direction();
        const auto value = [&](const Float3& w) {
            return 1.5f + slope[0] * w[0] + slope[1] * w[1] + slope[2] * w[2];
        };
        BasisColours colours;
        for (std::size_t b = 0; b < 4; ++b)
            colours[b] = {value(transfer_basis[b]), 2 * value(transfer_basis[b]), 0};
        const Float3 normal = random.direction();
        const Float3 ambient = shade_ambient(RelightMode::accurate, colours, normal);
        ASSERT_NEAR(ambient[0], value(normal), 1e-5);
        ASSERT_NEAR(ambient[1], 2 * value(normal), 2e-5);
    }
}

// An open sky of radiance 1: half of it falls on a wall, whichever way it faces.
TEST(ShadeAmbient, OpenSkyFallsAlikeOnAllWalls) {
    const BasisColours colours = open_sky(white_sky());
    for (int degrees = 0; degrees < 360; degrees += 7) {
        const float angle = static_cast<float>(degrees) * 0.0174533f;
        for (const float height : {-1.0f, -0.6f, 0.0f, 0.3f, 1.0f}) {
            const float side = std::sqrt(1 - height * height);
            const Float3 normal = {side * std::cos(angle), side * std::sin(angle), height};
            EXPECT_NEAR(shade_ambient(RelightMode::accurate, colours, normal)[0], (1 + height) / 2, 1e-5);
        }
    }
}

TEST(ShadeAmbient, NormalsThatAreNoneGiveDefinedResults) {
    const BasisColours colours = {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}};
    const float nan = std::nanf("");
    for (const RelightMode mode : {RelightMode::literal, RelightMode::accurate}) {
        for (const Float3& normal : {Float3{0, 0, 0}, {nan, 0, 1}, {0, INFINITY, 0}}) {
            const Float3 ambient = shade_ambient(mode, colours, normal);
            EXPECT_GT(ambient[0], 0.4f);
            EXPECT_LE(ambient[2], 3.0001f);
        }
    }
}

TEST(Clamped, NothingBelowZeroAndNoNan) {
    const float nan = std::nanf("");
    const BasisColours expected = {{{0, 0, 2}, {}, {}, {}}};
    EXPECT_EQ(clamped({{{-1, nan, 2}, {}, {-0.0f, 0, 0}, {}}}), expected);
}

}  // namespace
}  // namespace drtv
