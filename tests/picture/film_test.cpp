#include "bakerd/picture/film.h"

#include "format/kit/srgb.h"

#include <gtest/gtest.h>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace drtv::test {
namespace {

float filmed(float radiance) {
    return picture::filmic(glm::vec3(radiance)).x;
}

TEST(Film, CurveStartsBlackRisesAndEndsWhite) {
    EXPECT_EQ(filmed(0), 0);
    EXPECT_EQ(filmed(-3), 0);
    float before = 0;
    for (float x = 0.01f; x < 20; x *= 1.2f) {
        EXPECT_GE(filmed(x), before) << x;
        before = filmed(x);
    }
    // The published formula, by hand: 0.18 (0.4818) / (0.18 x 1.0274 + 0.14), and 2.54 / 3.16.
    EXPECT_NEAR(filmed(0.18f), 0.0867240f / 0.3249320f, 1e-6f);
    EXPECT_NEAR(filmed(1), 2.54f / 3.16f, 1e-6f);
    EXPECT_EQ(filmed(1000), 1);
    EXPECT_EQ(filmed(std::numeric_limits<float>::infinity()), 1);
    EXPECT_EQ(filmed(std::numeric_limits<float>::max()), 1);
}

TEST(Film, ChannelsAreDevelopedApart) {
    const glm::vec3 shown = picture::filmic({0, 0.18f, 1});
    EXPECT_EQ(shown.x, filmed(0));
    EXPECT_EQ(shown.y, filmed(0.18f));
    EXPECT_EQ(shown.z, filmed(1));
}

TEST(Film, ExposureDoublesByTheStop) {
    EXPECT_EQ(picture::exposure_of(0), 1);
    EXPECT_EQ(picture::exposure_of(-3), 0.125f);
    EXPECT_NEAR(picture::exposure_of(0.5f), std::sqrt(2.0f), 1e-6f);
    // Twice the light takes one stop less.
    for (const float mean : {0.001f, 0.3f, 70.0f}) {
        const float ev = picture::ev_for(picture::log2_of(static_cast<double>(mean)));
        EXPECT_EQ(ev * 4, std::round(ev * 4));
        EXPECT_EQ(picture::ev_for(picture::log2_of(static_cast<double>(2 * mean))), ev - 1);
        EXPECT_NEAR(mean * picture::exposure_of(ev), 0.32f, 0.32f * 0.1f);
    }
}

TEST(Film, LogarithmIsTheLibrarys) {
    for (double x = 1e-30; x < 1e30; x *= 1.37)
        EXPECT_NEAR(picture::log2_of(x), std::log2(x), 1e-13 * std::max(1.0, std::abs(std::log2(x)))) << x;
    for (int n = -40; n < 40; ++n)
        EXPECT_NEAR(picture::exposure_of(static_cast<float>(n) * 0.125f), std::exp2(n * 0.125),
                    1e-6 * std::exp2(n * 0.125));
}

TEST(Srgb, AgreesWithTheFormula) {
    for (int n = -100; n <= 12000; ++n) {
        const double x = n / 10000.0;
        const double c = std::clamp(x, 0.0, 1.0);
        const double code = 255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
        if (std::abs(code - std::floor(code) - 0.5) < 1e-3)
            continue;
        EXPECT_EQ(kit::encode_srgb(static_cast<float>(x)), std::lround(code)) << x;
    }
    EXPECT_EQ(kit::encode_srgb(std::numeric_limits<float>::quiet_NaN()), 0);
    EXPECT_EQ(kit::encode_srgb(std::numeric_limits<float>::infinity()), 255);
    EXPECT_EQ(kit::encode_srgb(-std::numeric_limits<float>::infinity()), 0);
}

}  // namespace
}  // namespace drtv::test
