// Filtered pictures: means over what is there, and bounds of alpha.
#include "bakerd/map/texture.h"
#include "tests/map/import_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace drtv::test {
namespace {

using map::Coverage;
using map::MipLevel;
using map::Texture;
using map::Wrap;

// Each texel of a mip is rounded to 16 bits: half a unit. The sums before it run in float.
constexpr double mip_tolerance = 0.5 / 65535 + 1e-6;
// Interpolation in float.
constexpr float rounding = 1e-5f;
// The same, of alphas in [0, 255].
constexpr float alpha_rounding = 1e-3f;

constexpr std::array<Wrap, 3> wraps = {Wrap::repeat, Wrap::clamp, Wrap::mirror};

double linear_of(std::uint8_t byte) {
    const double s = byte / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

Texture texture_of(std::uint32_t width, std::uint32_t height, std::vector<std::uint8_t> rgba,
                   Coverage coverage = Coverage::whole, float cutoff = 0) {
    Texture texture;
    texture.width = width;
    texture.height = height;
    texture.coverage = coverage;
    texture.cutoff = cutoff;
    texture.rgba = std::move(rgba);
    map::prefilter(texture);
    return texture;
}

Texture noise(std::mt19937& random, std::uint32_t width, std::uint32_t height, Coverage coverage,
              float cutoff) {
    std::vector<std::uint8_t> rgba(std::size_t{width} * height * 4);
    for (std::uint8_t& byte : rgba)
        byte = static_cast<std::uint8_t>(random());
    return texture_of(width, height, std::move(rgba), coverage, cutoff);
}

// Mean of colour times coverage, and of coverage.
glm::dvec4 mean_of(const Texture& texture) {
    glm::dvec4 sum(0);
    for (std::size_t n = 0; n < texture.rgba.size(); n += 4) {
        const double alpha = texture.rgba[n + 3] / 255.0;
        const double there = texture.coverage == Coverage::whole   ? 1
                             : texture.coverage == Coverage::alpha ? alpha
                             : alpha >= double{texture.cutoff}     ? 1
                                                                   : 0;
        sum += glm::dvec4(linear_of(texture.rgba[n]), linear_of(texture.rgba[n + 1]),
                          linear_of(texture.rgba[n + 2]), 1) *
               there;
    }
    return sum / static_cast<double>(texture.rgba.size() / 4);
}

glm::dvec4 mean_of(const MipLevel& mip) {
    glm::dvec4 sum(0);
    for (std::size_t n = 0; n < mip.rgba.size(); n += 4)
        sum += glm::dvec4(mip.rgba[n], mip.rgba[n + 1], mip.rgba[n + 2], mip.rgba[n + 3]) / 65535.0;
    return sum / static_cast<double>(mip.rgba.size() / 4);
}

TEST(Prefilter, EveryMipKeepsTheMean) {
    std::mt19937 random(1);
    for (const auto& [width, height] : {std::pair{5u, 3u},
                                        {7u, 1u},
                                        {1u, 7u},
                                        {2u, 2u},
                                        {8u, 8u},
                                        {6u, 4u},
                                        {13u, 9u},
                                        {31u, 2u},
                                        {33u, 17u}}) {
        for (const Coverage coverage : {Coverage::whole, Coverage::alpha, Coverage::cutoff}) {
            SCOPED_TRACE(testing::Message()
                         << width << " x " << height << ", coverage " << static_cast<int>(coverage));
            const Texture texture = noise(random, width, height, coverage, 0.401f);
            const glm::dvec4 mean = mean_of(texture);
            std::uint32_t w = width, h = height;
            for (const MipLevel& mip : texture.mips) {
                w = std::max(1u, w / 2), h = std::max(1u, h / 2);
                EXPECT_EQ(std::pair(mip.width, mip.height), std::pair(w, h));
                ASSERT_EQ(mip.rgba.size(), std::size_t{w} * h * 4);
                for (glm::length_t k = 0; k < 4; ++k)
                    EXPECT_NEAR(mean_of(mip)[k], mean[k], mip_tolerance)
                        << "component " << k << " of " << w << " x " << h;
            }
            EXPECT_EQ(std::pair(w, h), std::pair(1u, 1u));
        }
    }
}

TEST(Prefilter, OneTexelHasNoMips) {
    EXPECT_TRUE(texture_of(1, 1, {1, 2, 3, 4}).mips.empty());
}

TEST(Prefilter, TexelsOfAMipAverageWhatTheyCover) {
    // Three texels become one and five become two: the middle one of five counts half to either side.
    const Texture texture =
        texture_of(5, 1, {255, 0, 0, 255, 255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 0, 0, 255, 255});
    ASSERT_EQ(texture.mips.at(0).width, 2u);
    const auto of = [&](std::size_t n) { return texture.mips[0].rgba.at(n) / 65535.0; };
    EXPECT_NEAR(of(0), 0.8, mip_tolerance);
    EXPECT_NEAR(of(1), 0.2, mip_tolerance);
    EXPECT_NEAR(of(4 + 1), 0.2, mip_tolerance);
    EXPECT_NEAR(of(4 + 2), 0.8, mip_tolerance);
}

TEST(SampleFiltered, CoverageWeighsColours) {
    // Red that is all there beside green that is there by a fifth.
    const std::vector<std::uint8_t> rgba = {255, 0, 0, 255, 0, 255, 0, 51};
    const auto mean = [&](Coverage coverage, float cutoff) {
        return map::sample_filtered(texture_of(2, 1, rgba, coverage, cutoff), {0.3f, 0.5f}, 1);
    };
    expect_near(mean(Coverage::whole, 0), {0.5f, 0.5f, 0}, rounding);
    expect_near(mean(Coverage::alpha, 0), {5 / 6.0f, 1 / 6.0f, 0}, 2 * rounding);
    expect_near(mean(Coverage::cutoff, 0.5f), {1, 0, 0}, rounding);
    expect_near(mean(Coverage::cutoff, 0.125f), {0.5f, 0.5f, 0}, rounding);
}

TEST(SampleFiltered, WhereNothingIsThereShowsThePictureItself) {
    for (const Coverage coverage : {Coverage::alpha, Coverage::cutoff}) {
        const Texture texture = texture_of(2, 1, {255, 0, 0, 0, 0, 255, 0, 0}, coverage, 0.5f);
        expect_near(map::sample_filtered(texture, {0.25f, 0.5f}, 1), {1, 0, 0}, rounding);
        expect_near(map::sample_filtered(texture, {0.75f, 0.5f}, 1), {0, 1, 0}, rounding);
    }
}

TEST(SampleFiltered, LevelZeroIsTheSampleAndLevelsEndAtTheLast) {
    std::mt19937 random(2);
    for (const Coverage coverage : {Coverage::whole, Coverage::alpha, Coverage::cutoff}) {
        Texture texture = noise(random, 13, 6, coverage, 0.3f);
        for (int n = 0; n < 300; ++n) {
            texture.wrap_u = wraps[random() % 3], texture.wrap_v = wraps[random() % 3];
            const glm::vec2 uv(static_cast<float>(random() % 4000) / 1000 - 2,
                               static_cast<float>(random() % 4000) / 1000 - 2);
            EXPECT_EQ(map::sample_filtered(texture, uv, 0), glm::vec3(map::sample(texture, uv)));
            const auto last = static_cast<std::uint32_t>(texture.mips.size());
            EXPECT_EQ(map::sample_filtered(texture, uv, last + 1), map::sample_filtered(texture, uv, last));
            EXPECT_EQ(map::sample_filtered(texture, uv, UINT32_MAX), map::sample_filtered(texture, uv, last));
        }
    }
}

TEST(SampleFiltered, EveryLevelShowsItsOwnMip) {
    std::mt19937 random(5);
    const Texture texture = noise(random, 19, 8, Coverage::whole, 0);
    ASSERT_EQ(texture.mips.size(), 4u);
    for (std::uint32_t level = 1; level <= 4; ++level) {
        const MipLevel& mip = texture.mips[level - 1];
        for (std::uint32_t n = 0; n < mip.width * mip.height; ++n) {
            const glm::vec2 centre(
                (static_cast<float>(n % mip.width) + 0.5f) / static_cast<float>(mip.width),
                (static_cast<float>(n / mip.width) + 0.5f) / static_cast<float>(mip.height));
            const std::uint16_t* p = &mip.rgba[n * std::size_t{4}];
            expect_near(map::sample_filtered(texture, centre, level), glm::vec3(p[0], p[1], p[2]) / 65535.0f,
                        rounding);
        }
    }
}

TEST(SampleFiltered, WrapsAsTheSamplerSays) {
    // 4 x 1 whose first mip is red, blue.
    Texture texture = texture_of(4, 1, {255, 0, 0, 255, 255, 0, 0, 255, 0, 0, 255, 255, 0, 0, 255, 255});
    const auto at = [&](Wrap wrap, float u) {
        texture.wrap_u = wrap;
        return map::sample_filtered(texture, {u, 0.5f}, 1);
    };
    expect_near(at(Wrap::repeat, 1.25f), {1, 0, 0}, rounding);
    expect_near(at(Wrap::mirror, 1.25f), {0, 0, 1}, rounding);
    expect_near(at(Wrap::clamp, -3.25f), {1, 0, 0}, rounding);
    expect_near(at(Wrap::repeat, 0), {0.5f, 0, 0.5f}, rounding);
    expect_near(at(Wrap::clamp, 0), {1, 0, 0}, rounding);
}

// Alpha of noise, of patches, or mostly of one value.
Texture alpha_picture(std::mt19937& random, std::uint32_t width, std::uint32_t height) {
    std::vector<std::uint8_t> rgba(std::size_t{width} * height * 4, 100);
    const std::uint32_t kind = static_cast<std::uint32_t>(random()) % 3,
                        patch = 1 + static_cast<std::uint32_t>(random()) % 20;
    std::array<std::uint8_t, 64> patches{};
    for (std::uint8_t& alpha : patches)
        alpha = random() % 2 == 0 ? 255 : static_cast<std::uint8_t>(random());
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::uint8_t any = static_cast<std::uint8_t>(random());
            rgba[(std::size_t{y} * width + x) * 4 + 3] = kind == 0 ? any
                                                         : kind == 1
                                                             ? patches[(x / patch * 7 + y / patch) % 64]
                                                         : random() % 200 == 0 ? any
                                                                               : 255;
        }
    }
    return texture_of(width, height, std::move(rgba), Coverage::alpha);
}

TEST(AlphaRange, BoundsEverySampleInsideTheBox) {
    std::mt19937 random(3);
    const auto between = [&](float low, float high) {
        return low + (high - low) * static_cast<float>(random() % 1048576u) / 1048576.0f;
    };
    int narrow = 0;
    for (const auto& [width, height] :
         {std::pair{1u, 1u}, {5u, 3u}, {8u, 8u}, {9u, 1u}, {17u, 40u}, {64u, 64u}, {100u, 30u}}) {
        for (int picture = 0; picture < 9; ++picture) {
            Texture texture = alpha_picture(random, width, height);
            texture.wrap_u = wraps[static_cast<std::size_t>(picture) % 3],
            texture.wrap_v = wraps[static_cast<std::size_t>(picture) / 3];
            for (int n = 0; n < 150; ++n) {
                const float size = n % 3 == 0 ? 0.02f : n % 3 == 1 ? 0.4f : 2.5f;
                const glm::vec2 low(between(-3, 3), between(-3, 3)),
                    high = low + glm::vec2(between(0, size), between(0, size));
                const map::AlphaRange range = map::alpha_range(texture, low, high);
                narrow += range.low == range.high ? 1 : 0;
                for (int k = 0; k < 40; ++k) {
                    // The corners first.
                    const glm::vec2 part =
                        k < 4 ? glm::vec2(k & 1, k >> 1) : glm::vec2(between(0, 1), between(0, 1));
                    const float alpha =
                        map::sample(texture, glm::min(low + (high - low) * part, high)).w * 255;
                    ASSERT_GE(alpha, range.low - alpha_rounding)
                        << width << " x " << height << ", picture " << picture << ", box " << n;
                    ASSERT_LE(alpha, range.high + alpha_rounding)
                        << width << " x " << height << ", picture " << picture << ", box " << n;
                }
            }
        }
    }
    EXPECT_GT(narrow, 100);
}

TEST(AlphaRange, IsTightWellInsideOnePart) {
    // Opaque but for a clear quarter at the picture's beginning.
    std::vector<std::uint8_t> rgba(64 * 64 * 4, 255);
    for (std::size_t y = 0; y < 32; ++y) {
        for (std::size_t x = 0; x < 32; ++x)
            rgba[(y * 64 + x) * 4 + 3] = 0;
    }
    Texture texture = texture_of(64, 64, std::move(rgba), Coverage::cutoff, 0.5f);
    const auto range = [&](glm::vec2 low, glm::vec2 high) {
        const map::AlphaRange r = map::alpha_range(texture, low, high);
        return std::pair(int{r.low}, int{r.high});
    };
    for (const Wrap wrap : wraps) {
        texture.wrap_u = texture.wrap_v = wrap;
        EXPECT_EQ(range({0.65f, 0.65f}, {0.85f, 0.85f}), std::pair(255, 255));
        EXPECT_EQ(range({0.1f, 0.65f}, {0.85f, 0.85f}), std::pair(255, 255));
        EXPECT_EQ(range({0.15f, 0.15f}, {0.35f, 0.35f}), std::pair(0, 0));
        EXPECT_EQ(range({0.15f, 0.15f}, {0.65f, 0.35f}), std::pair(0, 255));
    }
    // Far outside, clamping shows the last texel only, and repetition all of them.
    texture.wrap_u = texture.wrap_v = Wrap::clamp;
    EXPECT_EQ(range({3, 3}, {4, 4}), std::pair(255, 255));
    EXPECT_EQ(range({-4, -4}, {-3, -3}), std::pair(0, 0));
    texture.wrap_u = texture.wrap_v = Wrap::repeat;
    EXPECT_EQ(range({3, 3}, {9, 9}), std::pair(0, 255));
    EXPECT_EQ(range({7.65f, -2.35f}, {7.85f, -2.15f}), std::pair(255, 255));
    texture.wrap_u = texture.wrap_v = Wrap::mirror;
    EXPECT_EQ(range({1.15f, 1.15f}, {1.35f, 1.35f}), std::pair(255, 255));
    EXPECT_EQ(range({1.65f, 1.65f}, {1.85f, 1.85f}), std::pair(0, 0));
}

TEST(Brightest, CountsOnlyTexelsThatAreThere) {
    const std::vector<std::uint8_t> rgba = {255, 0, 0, 100, 0, 128, 0, 200, 0, 0, 255, 0};
    const auto half = static_cast<float>(linear_of(128));
    expect_near(map::brightest(texture_of(3, 1, rgba, Coverage::whole)), {1, half, 1}, rounding);
    expect_near(map::brightest(texture_of(3, 1, rgba, Coverage::alpha)), {1, half, 0}, rounding);
    expect_near(map::brightest(texture_of(3, 1, rgba, Coverage::cutoff, 0.5f)), {0, half, 0}, rounding);
    expect_near(map::brightest(texture_of(3, 1, rgba, Coverage::cutoff, 1)), {0, 0, 0});
}

TEST(SampleAlpha, IsTheAlphaOfTheSample) {
    std::mt19937 random(17);
    std::uniform_real_distribution<float> uv(-3, 3);
    Texture texture = noise(random, 7, 12, Coverage::alpha, 0);
    for (const Wrap wrap : wraps) {
        texture.wrap_u = texture.wrap_v = wrap;
        for (int n = 0; n < 2000; ++n) {
            const glm::vec2 at(uv(random), uv(random));
            ASSERT_EQ(map::sample_alpha(texture, at), map::sample(texture, at).w) << at.x << " " << at.y;
        }
    }
}

}  // namespace
}  // namespace drtv::test
