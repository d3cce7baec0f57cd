// What eight bits do to shaded values, and numbers of binary16.
#include "format/runtime/src/volume_texels.h"

#include <drtv/relight.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace drtv {
namespace {

struct Errors {
    double rms;
    double p999;  // 99.9 % are smaller
};

// Relative errors of shaded values: basis colours of 0.3 to 1 times the level, through the texels, at random
// normals.
Errors errors_of(TexelEncoding encoding, RelightMode mode, float level) {
    std::mt19937 engine(6);
    std::uniform_real_distribution<float> share(0.3f, 1);
    std::normal_distribution<float> component;
    const Encoder encoder{encoding, 1};
    const auto through = [&](float x) {
        if (encoding == TexelEncoding::rgba16f)
            return float_of_half(half_of(x));
        const float code = static_cast<float>(encoder.byte_of(x)) / 255;
        return encoding == TexelEncoding::rgba8 ? code : code * code;
    };
    std::vector<double> errors;
    for (int n = 0; n < 40000; ++n) {
        BasisColours colours{}, stored{};
        for (std::size_t b = 0; b < 4; ++b) {
            colours[b][0] = level * share(engine);
            stored[b][0] = through(colours[b][0]);
        }
        Float3 normal = {component(engine), component(engine), component(engine)};
        const float length = std::hypot(normal[0], normal[1], normal[2]);
        for (float& x : normal)
            x /= length;
        const auto shaded = [&](const BasisColours& c) {
            return static_cast<double>(shade_ambient(mode, c, normal)[0]);
        };
        // Where next to nothing is left of four colours, a relative error says nothing.
        if (shaded(colours) > 0.2 * static_cast<double>(level))
            errors.push_back(std::abs(shaded(stored) / shaded(colours) - 1));
    }
    std::sort(errors.begin(), errors.end());
    double sum = 0;
    for (const double error : errors)
        sum += error * error;
    const auto count = static_cast<double>(errors.size());
    return {std::sqrt(sum / count), errors[static_cast<std::size_t>(0.999 * count)]};
}

TEST(Encodings, ShadedValuesKeepTheirBounds) {
    struct Bound {
        TexelEncoding encoding;
        RelightMode mode;
        float level;
        double rms, p999;
    };
    constexpr auto linear = TexelEncoding::rgba8, root = TexelEncoding::rgba8_sqrt,
                   half = TexelEncoding::rgba16f;
    constexpr auto literal = RelightMode::literal, accurate = RelightMode::accurate;
    for (const Bound& bound : {Bound{linear, literal, 0.3f, 0.006, 0.02},
                               {linear, accurate, 0.3f, 0.009, 0.04},
                               {linear, literal, 0.1f, 0.018, 0.06},
                               {linear, accurate, 0.1f, 0.025, 0.12},
                               {linear, literal, 0.03f, 0.06, 0.2},
                               {linear, accurate, 0.03f, 0.085, 0.41},
                               {root, literal, 0.3f, 0.0045, 0.0125},
                               {root, accurate, 0.3f, 0.0065, 0.03},
                               {root, literal, 0.1f, 0.008, 0.021},
                               {root, accurate, 0.1f, 0.0115, 0.055},
                               {root, literal, 0.03f, 0.015, 0.04},
                               {root, accurate, 0.03f, 0.021, 0.09},
                               {half, accurate, 0.03f, 0.0005, 0.002},
                               {half, accurate, 0.001f, 0.0005, 0.002}}) {
        const Errors found = errors_of(bound.encoding, bound.mode, bound.level);
        EXPECT_LE(found.rms, bound.rms) << static_cast<int>(bound.encoding) << " " << bound.level;
        EXPECT_LE(found.p999, bound.p999) << static_cast<int>(bound.encoding) << " " << bound.level;
        // Not better than it can be: the codes are there.
        EXPECT_GT(found.rms, bound.rms / 4) << static_cast<int>(bound.encoding) << " " << bound.level;
    }
}

TEST(Encodings, CodesAreRoundedAndClamped) {
    const Encoder encoder{TexelEncoding::rgba8, 0.25f};
    EXPECT_EQ(encoder.byte_of(0), 0);
    EXPECT_EQ(encoder.byte_of(4), 255);
    EXPECT_EQ(encoder.byte_of(1000), 255);
    EXPECT_EQ(encoder.byte_of(4 * 0.49f / 255), 0);
    EXPECT_EQ(encoder.byte_of(4 * 0.51f / 255), 1);
    EXPECT_EQ((Encoder{TexelEncoding::rgba8_sqrt, 0.25f}.byte_of(1)), 128);
}

// Every number of binary16, and what lies between two.
TEST(Half, GoesThereAndBack) {
    for (std::uint32_t half = 0; half <= 0x7BFF; ++half) {
        const float x = float_of_half(static_cast<std::uint16_t>(half));
        ASSERT_EQ(half_of(x), half);
        if (half == 0x7BFF)
            continue;
        const float next = float_of_half(static_cast<std::uint16_t>(half + 1));
        ASSERT_GT(next, x);
        const float middle = x + (next - x) / 2;
        ASSERT_EQ(half_of(middle), half % 2 == 0 ? half : half + 1) << "ties to even";
        ASSERT_EQ(half_of(std::nextafter(middle, 0.0f)), half);
        ASSERT_EQ(half_of(std::nextafter(middle, next)), half + 1);
    }
    EXPECT_EQ(float_of_half(0x3C00), 1);
    EXPECT_EQ(half_of(-1), 0);
    EXPECT_EQ(half_of(std::nanf("")), 0);
    EXPECT_EQ(half_of(INFINITY), 0x7BFF);
    EXPECT_EQ(half_of(1e30f), 0x7BFF);
}

}  // namespace
}  // namespace drtv
