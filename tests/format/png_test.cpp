// encode_png() read back by stb_image.
#include "format/image/png.h"

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
#include <span>
#include <string>
#include <vector>

namespace drtv::image {
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
    const std::vector<std::uint8_t> png = encode_png(image).value();
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

TEST(PngWriter, SmoothPictureIsReadBackAndSmall) {
    const Image image = paint(640, 400, [](std::size_t x, std::size_t y, std::size_t c) {
        return static_cast<std::uint8_t>(x / 4 + y / 8 + 20 * c);
    });
    EXPECT_LT(expect_read_back(image), image.rgb.size() / 20);
}

TEST(PngTexts, AreReadBackAndShowNothing) {
    const Image image =
        paint(9, 4, [](auto x, auto y, auto c) { return static_cast<std::uint8_t>(x * y + c); });
    const std::vector<std::uint8_t> png = encode_png(image, {{"one", "1,2.5"}, {"two", ""}}).value();
    EXPECT_EQ(png_text(png, "one"), "1,2.5");
    EXPECT_EQ(png_text(png, "two"), "");
    EXPECT_FALSE(png_text(png, "three"));
    EXPECT_FALSE(png_text(png, "on"));
    EXPECT_FALSE(png_text(encode_png(image).value(), "one"));
    const auto decoded = decode_png(png);
    ASSERT_TRUE(decoded) << decoded.error().sentence;
    EXPECT_EQ(decoded->rgb, image.rgb);
}

TEST(PngDecoder, TakesAnEmptyChunkOfPixels) {
    const Image image =
        paint(7, 5, [](auto x, auto y, auto c) { return static_cast<std::uint8_t>(x + y + c); });
    std::vector<std::uint8_t> png = encode_png(image).value();
    const std::string chunk("\0\0\0\0IDAT\x35\xAF\x06\x1E", 12);
    png.insert(png.begin() + 33, chunk.begin(), chunk.end());
    const auto decoded = decode_png(png);
    ASSERT_TRUE(decoded) << decoded.error().sentence;
    EXPECT_EQ(decoded->rgb, image.rgb);
}

TEST(PngDecoder, AnyPrefixAndAnyChangedByteIsDefined) {
    const Image image =
        paint(7, 5, [](auto x, auto y, auto c) { return static_cast<std::uint8_t>(31 * x + y + 7 * c); });
    const std::vector<std::uint8_t> png = encode_png(image, {{"key", "text"}}).value();
    for (std::size_t size = 0; size < png.size(); ++size) {
        const std::span<const std::uint8_t> part(png.data(), size);
        const auto read = decode_png(part);
        EXPECT_TRUE(read || !read.error().sentence.empty());
        (void)png_text(part, "key");
    }
    for (std::size_t at = 0; at < png.size(); ++at) {
        std::vector<std::uint8_t> changed = png;
        for (const int value : {0, 1, 127, 255}) {
            changed[at] = static_cast<std::uint8_t>(value);
            (void)decode_png(changed);
            (void)png_text(changed, "key");
        }
    }
    EXPECT_FALSE(decode_png({}));
}

}  // namespace
}  // namespace drtv::image
