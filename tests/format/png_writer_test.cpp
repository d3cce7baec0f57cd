// encode_png() read back by stb_image.
#include "format/tool/png_writer.h"

#include <gtest/gtest.h>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <cstring>
#include <functional>
#include <random>

namespace drtv::tool {
namespace {

using Colour = std::function<std::uint8_t(std::size_t x, std::size_t y, std::size_t channel)>;

Image paint(std::size_t width, std::size_t height, const Colour& colour) {
    Image image(width, height);
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            for (std::size_t c = 0; c < 3; ++c)
                image.at(x, y)[c] = colour(x, y, c);
        }
    }
    return image;
}

// The size of the PNG.
std::size_t expect_read_back(const Image& image) {
    const std::vector<std::uint8_t> png = encode_png(image);
    int width = 0, height = 0, channels = 0;
    stbi_uc* pixels =
        stbi_load_from_memory(png.data(), static_cast<int>(png.size()), &width, &height, &channels, 0);
    EXPECT_NE(pixels, nullptr) << stbi_failure_reason();
    if (pixels == nullptr)
        return 0;
    EXPECT_EQ(static_cast<std::size_t>(width), image.width);
    EXPECT_EQ(static_cast<std::size_t>(height), image.height);
    EXPECT_EQ(channels, 3);
    EXPECT_EQ(std::memcmp(pixels, image.rgb.data(), image.rgb.size()), 0)
        << image.width << " x " << image.height;
    stbi_image_free(pixels);
    return png.size();
}

TEST(PngWriter, RandomPixelsAreReadBack) {
    std::mt19937 random(1);
    for (std::size_t width : {1u, 2u, 3u, 5u, 64u, 117u}) {
        for (std::size_t height : {1u, 2u, 7u, 90u})
            expect_read_back(
                paint(width, height, [&](auto...) { return static_cast<std::uint8_t>(random()); }));
    }
}

TEST(PngWriter, FewColoursAreReadBack) {
    // Many short matches at many distances.
    std::mt19937 random(2);
    expect_read_back(paint(300, 200, [&](auto...) { return static_cast<std::uint8_t>(random() % 2); }));
    expect_read_back(paint(300, 200, [&](std::size_t x, std::size_t, std::size_t) {
        return static_cast<std::uint8_t>(x % 7 == 0 ? random() % 3 : 0);
    }));
}

TEST(PngWriter, SmoothPictureIsReadBackAndSmall) {
    const Image image = paint(640, 400, [](std::size_t x, std::size_t y, std::size_t c) {
        return static_cast<std::uint8_t>(x / 4 + y / 8 + 20 * c);
    });
    EXPECT_LT(expect_read_back(image), image.rgb.size() / 20);
}

TEST(PngWriter, OneColourIsReadBackAndSmall) {
    // Matches of the greatest length, overlapping themselves.
    const Image image = paint(1000, 700, [](auto...) { return std::uint8_t{200}; });
    EXPECT_LT(expect_read_back(image), image.rgb.size() / 80);  // 13 bits for 258 bytes
}

TEST(PngWriter, RepeatsAroundTheWindowAreReadBack) {
    // Rows of random bytes that come again after 32768 bytes less, exactly, and more: 3 width + 1 bytes a
    // row.
    std::mt19937 random(4);
    for (std::size_t width : {10922u, 10923u, 5461u, 16383u}) {
        std::vector<std::uint8_t> row(3 * width);
        for (std::uint8_t& byte : row)
            byte = static_cast<std::uint8_t>(random());
        expect_read_back(
            paint(width, 4, [&](std::size_t x, std::size_t, std::size_t c) { return row[3 * x + c]; }));
        // Within a row too: 3 width bytes apart, of which 3 * 10923 is the first that is too far.
        expect_read_back(paint(2 * width, 1, [&](std::size_t x, std::size_t, std::size_t c) {
            return row[3 * (x % width) + c];
        }));
    }
}

TEST(PngWriter, EveryMatchLengthIsReadBack) {
    // Runs of every length from 0 to 300 between random bytes.
    std::mt19937 random(5);
    std::vector<std::uint8_t> bytes;
    for (std::size_t run = 0; run < 300; ++run) {
        bytes.push_back(static_cast<std::uint8_t>(random()));
        bytes.insert(bytes.end(), 3 * run, bytes.back());
    }
    const std::size_t width = bytes.size() / 3;
    expect_read_back(
        paint(width, 1, [&](std::size_t x, std::size_t, std::size_t c) { return bytes[3 * x + c]; }));
}

}  // namespace
}  // namespace drtv::tool
