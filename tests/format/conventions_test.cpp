#include <drtv/conventions.h>
#include <drtv/sector.h>

#include <gtest/gtest.h>

#include <climits>
#include <cmath>
#include <limits>
#include <numbers>

namespace drtv {
namespace {

// The constants stand with six digits.
constexpr double constant_tolerance = 1.5e-6;
// Midpoint sums over 400 x 800 directions are good to about 1e-5.
constexpr double integral_tolerance = 3e-5;

constexpr std::array<float, 2> scales = {transfer_scale, sky_visibility_scale};

double dot(const Float3& a, const Float3& b) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
        sum += static_cast<double>(a[k]) * static_cast<double>(b[k]);
    return sum;
}

template <class Integrand>
double integrate_sphere(Integrand integrand) {
    constexpr int thetas = 400, phis = 800;
    double sum = 0;
    for (int t = 0; t < thetas; ++t) {
        const double theta = (t + 0.5) * std::numbers::pi / thetas;
        for (int p = 0; p < phis; ++p) {
            const double phi = (p + 0.5) * 2 * std::numbers::pi / phis;
            const Float3 w = {static_cast<float>(std::sin(theta) * std::cos(phi)),
                              static_cast<float>(std::sin(theta) * std::sin(phi)),
                              static_cast<float>(std::cos(theta))};
            sum += integrand(w) * std::sin(theta);
        }
    }
    return sum * (std::numbers::pi / thetas) * (2 * std::numbers::pi / phis);
}

TEST(TransferBasis, FirstThreeAreOrthonormal) {
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b)
            EXPECT_NEAR(dot(transfer_basis[a], transfer_basis[b]), a == b ? 1 : 0, constant_tolerance)
                << a << b;
    }
}

TEST(TransferBasis, FirstThreeLeanEquallyFromUp) {
    for (std::size_t b = 0; b < 3; ++b)
        EXPECT_NEAR(transfer_basis[b][2], 1 / std::sqrt(3.0), constant_tolerance);
}

TEST(TransferBasis, LastIsStraightDown) {
    EXPECT_EQ(transfer_basis[3], (Float3{0, 0, -1}));
}

TEST(SphericalHarmonics, AreOrthonormalByIntegration) {
    for (std::size_t i = 0; i < sh_count; ++i) {
        for (std::size_t j = 0; j < sh_count; ++j) {
            const double integral = integrate_sphere([&](const Float3& w) {
                const Float4 y = evaluate_sh(w);
                return static_cast<double>(y[i]) * static_cast<double>(y[j]);
            });
            EXPECT_NEAR(integral, i == j ? 1 : 0, integral_tolerance) << i << j;
        }
    }
}

TEST(SphericalHarmonics, StandInTheOrderOneYZX) {
    EXPECT_EQ(evaluate_sh({1, 0, 0}), (Float4{sh_y0, 0, 0, sh_y1}));
    EXPECT_EQ(evaluate_sh({0, 1, 0}), (Float4{sh_y0, sh_y1, 0, 0}));
    EXPECT_EQ(evaluate_sh({0, 0, 1}), (Float4{sh_y0, 0, sh_y1, 0}));
}

TEST(SphericalHarmonics, ConstantsAreTheRootsRounded) {
    EXPECT_NEAR(sh_y0, 1 / (2 * std::sqrt(std::numbers::pi)), constant_tolerance);
    EXPECT_NEAR(sh_y1, std::sqrt(3 / (4 * std::numbers::pi)), constant_tolerance);
}

// The share of the open sky in a direction's colour: docs/design.md, section 2 calls it o.
TEST(SphericalHarmonics, OpenSkyShareOfUpwardBasisIsAsWritten) {
    const double lobe = integrate_sphere(
        [](const Float3& w) { return w[2] > 0 ? std::max(0.0, dot(w, transfer_basis[0])) : 0.0; });
    EXPECT_NEAR(lobe / std::numbers::pi, 0.7887, 1e-4);
}

TEST(TransferBound, HoldsTheCodesOfThePassiveExtremes) {
    EXPECT_LE(
        decode_fixed(encode_fixed(static_cast<float>(1 / (2 * std::sqrt(std::numbers::pi))), transfer_scale),
                     transfer_scale),
        transfer_bound_y0);
    EXPECT_LE(
        decode_fixed(encode_fixed(static_cast<float>(std::sqrt(3 / (4 * std::numbers::pi))), transfer_scale),
                     transfer_scale),
        transfer_bound_y1);
}

TEST(FixedPoint, EveryCodeComesBack) {
    for (float scale : scales) {
        for (int q = -32767; q <= 32767; ++q) {
            ASSERT_EQ(encode_fixed(decode_fixed(static_cast<std::int16_t>(q), scale), scale), q) << scale;
        }
    }
}

TEST(FixedPoint, NearestCodeIsChosen) {
    for (float scale : scales) {
        const double step = static_cast<double>(scale) / 32767;
        for (int n = -100'000; n <= 100'000; ++n) {
            const float value = static_cast<float>(n) * 1.0001e-5f * scale;
            if (std::abs(value) >= scale)
                continue;
            const double exact = static_cast<double>(value) / step;
            ASSERT_LE(std::abs(exact - encode_fixed(value, scale)), 0.5) << value;
        }
    }
}

TEST(FixedPoint, JustBelowHalfAStepIsZero) {
    // 32767 v < 1/2 by less than a float resolves: rounding in float would give 1.
    float value = 0.5f / 32767;
    while (static_cast<double>(value) * 32767 >= 0.5)
        value = std::nextafter(value, 0.0f);
    EXPECT_EQ(encode_fixed(value, 1), 0);
    EXPECT_EQ(encode_fixed(-value, 1), 0);
}

TEST(FixedPoint, HalfAStepGoesAwayFromZero) {
    // 16383.5 / 32767 = 0.5 exactly.
    EXPECT_EQ(encode_fixed(0.5f, 1), 16384);
    EXPECT_EQ(encode_fixed(-0.5f, 1), -16384);
    EXPECT_EQ(encode_fixed(0.25f, 0.5f), 16384);
}

TEST(FixedPoint, NeverFallsWhereTheValueRises) {
    std::int16_t last = -32767;
    for (int n = -120'000; n <= 120'000; ++n) {
        const std::int16_t q = encode_fixed(static_cast<float>(n) * 1e-5f, 1);
        ASSERT_GE(q, last);
        last = q;
    }
}

TEST(FixedPoint, OutsideSaturatesAndNotANumberIsZero) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (float scale : scales) {
        for (float value : {scale, scale * 1.5f, 1e30f, infinity}) {
            EXPECT_EQ(encode_fixed(value, scale), 32767);
            EXPECT_EQ(encode_fixed(-value, scale), -32767);
        }
        EXPECT_EQ(encode_fixed(std::numeric_limits<float>::quiet_NaN(), scale), 0);
        EXPECT_EQ(encode_fixed(0.0f, scale), 0);
        EXPECT_EQ(encode_fixed(-0.0f, scale), 0);
        EXPECT_EQ(encode_fixed(std::numeric_limits<float>::denorm_min(), scale), 0);
    }
}

TEST(FixedPoint, DecodesToTheNearestFloat) {
    for (float scale : scales) {
        for (int q = -32767; q <= 32767; ++q) {
            const double exact = q / 32767.0 * static_cast<double>(scale);
            ASSERT_EQ(decode_fixed(static_cast<std::int16_t>(q), scale), static_cast<float>(exact)) << q;
        }
    }
}

TEST(Scale, OfAnExponentIsAnExactPowerOfTwo) {
    for (int e = -126; e <= 126; ++e)
        ASSERT_EQ(scale_of_exponent(e), std::ldexp(1.0f, e)) << e;
}

TEST(Scale, OfAnExponentBeyondTheLimitIsThatOfTheLimit) {
    for (int e : {127, 128, 254, INT_MAX})
        EXPECT_EQ(scale_of_exponent(e), std::ldexp(1.0f, 126)) << e;
    for (int e : {-127, -128, -256, INT_MIN})
        EXPECT_EQ(scale_of_exponent(e), std::ldexp(1.0f, -126)) << e;
}

TEST(Position, StandsInTheSectorInWholeUnits) {
    Sector sector;
    sector.i = -1;
    sector.j = 2;
    sector.z_origin_units = -5;
    sector.z_shift = 3;
    const Probe probe{.position = {1, 65535, 2}};
    EXPECT_EQ(position_units(sector, probe), (std::array<std::int32_t, 3>{-65535, 196607, 11}));
    EXPECT_EQ(position_m(sector, probe), (Float3{-65535.0f / 1024, 196607.0f / 1024, 11.0f / 1024}));
}

TEST(Position, FarthestCornersFit32Bits) {
    Sector sector;
    for (std::int32_t sign : {-1, 1}) {
        sector.i = sector.j = sign * max_sector_coordinate;
        sector.z_origin_units = sign * max_z_origin_units;
        sector.z_shift = max_z_shift;
        const auto units = position_units(sector, Probe{.position = {65535, 65535, 65535}});
        EXPECT_EQ(units[0], std::int64_t{sector.i} * 65536 + 65535);
        EXPECT_EQ(units[2], std::int64_t{sector.z_origin_units} + (std::int64_t{65535} << 10));
    }
}

}  // namespace
}  // namespace drtv
