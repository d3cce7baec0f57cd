// The frame of a map from above.
#include "format/image/map_sheet.h"
#include "format/image/png_file.h"
#include "format/image/underlay.h"
#include "tests/store/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace drtv::image {
namespace {

using Sectors = std::vector<std::array<std::int32_t, 2>>;

constexpr Colour marker = {255, 0, 255};

// The bounds of what has the colour; x1 and y1 are behind the last.
PixelRect bounds_of(const Image& image, const Colour& colour) {
    PixelRect bounds{static_cast<int>(image.width), static_cast<int>(image.height), 0, 0};
    for (std::size_t y = 0; y < image.height; ++y) {
        for (std::size_t x = 0; x < image.width; ++x) {
            if (!std::equal(colour.begin(), colour.end(), image.at(x, y)))
                continue;
            bounds.x0 = std::min(bounds.x0, static_cast<int>(x));
            bounds.y0 = std::min(bounds.y0, static_cast<int>(y));
            bounds.x1 = std::max(bounds.x1, static_cast<int>(x) + 1);
            bounds.y1 = std::max(bounds.y1, static_cast<int>(y) + 1);
        }
    }
    return bounds;
}

Image plain(const MapExtent& extent) {
    Image map(extent.width, extent.height);
    fill(map, {0, 0, static_cast<int>(map.width), static_cast<int>(map.height)}, marker);
    return map;
}

TEST(MapSheet, HoldsTheMapWholeWhateverItsShape) {
    for (const Sectors& sectors : {Sectors{{0, 0}}, Sectors{{0, 0}, {99, 0}}, Sectors{{-3, 7}, {-3, 300}},
                                   Sectors{{-16384, -16384}, {16383, 16383}}}) {
        for (const double scale : {0.0, 0.5, 1000.0, 1e-9}) {
            if (sectors.front()[0] == -16384 && scale > 0 && scale < 1)
                continue;  // as large as the one without a scale, and slow
            const MapExtent extent = measure(sectors, scale);
            const MapSheet sheet = framed(plain(extent), extent, {"title", {{{1, 2, 3}, "entry"}}});
            const PixelRect map = bounds_of(sheet.image, marker);
            EXPECT_EQ(map.x1 - map.x0, static_cast<int>(extent.width));
            EXPECT_EQ(map.y1 - map.y0, static_cast<int>(extent.height));
            EXPECT_GE(std::min(sheet.image.width, sheet.image.height), min_sheet_side);
            EXPECT_LE(std::max(sheet.image.width, sheet.image.height), max_sheet_side);
        }
    }
}

TEST(MapSheet, IsNeverLargerThanSaid) {
    const std::string words =
        "largest relative standard error of the parts of a probe's light (2 sectors, 1,234 probes)";
    for (const Sectors& sectors :
         {Sectors{{-16384, -16384}, {16383, 16383}}, Sectors{{16383, -16384}, {16383, 16383}},
          Sectors{{-16384, -16384}, {16383, -16384}}}) {
        const MapExtent extent = measure(sectors, 1e-9);
        EXPECT_NE(extent.note, "");
        const std::vector<LegendEntry> legend(6, {{1, 2, 3}, words});
        const MapSheet sheet = framed(plain(extent), extent, {words + " " + words, legend});
        EXPECT_LE(std::max(sheet.image.width, sheet.image.height), max_sheet_side);
    }
}

TEST(MapSheet, SaysWhichPartOfTheWorldItShows) {
    const test::TemporaryFolder folder;
    const MapExtent extent = measure(Sectors{{-1, 2}, {3, 4}}, 0.5);
    Image map(extent.width, extent.height);
    fill(map, {0, 0, static_cast<int>(map.width), static_cast<int>(map.height)}, white);
    // The pixel at (10.25, 200.25).
    const int x = static_cast<int>(extent.x_px(10.25));
    const int y = static_cast<int>(extent.y_px(200.25));
    fill(map, {x, y, x + 1, y + 1}, marker);
    const MapSheet sheet = framed(map, extent, {"title", {}});
    const std::string path = folder.path() + "/sheet.png";
    ASSERT_TRUE(write_png_file(path, sheet.image, sheet.texts));
    const auto under = Underlay::read(path);
    ASSERT_TRUE(under) << under.error().sentence;
    const std::uint8_t* there = under->at(10.25, 200.25);
    ASSERT_NE(there, nullptr);
    EXPECT_TRUE(std::equal(marker.begin(), marker.end(), there));
    EXPECT_TRUE(std::equal(white.begin(), white.end(), under->at(10.75, 200.25)));
    EXPECT_TRUE(std::equal(white.begin(), white.end(), under->at(10.25, 199.75)));
    EXPECT_EQ(under->at(-65, 200), nullptr) << "the frame is no part of the map";
    EXPECT_NE(under->at(-63, 200), nullptr);
    const auto same = Underlay::read(path, path);
    ASSERT_FALSE(same);
    EXPECT_EQ(same.error().code, cli::exit_usage);
}

TEST(MapExtent, AScaleThatIsTooFineIsToldAndAllOthersKept) {
    EXPECT_EQ(measure(Sectors{{0, 0}}, 0.5).metres_per_pixel, 0.5);
    EXPECT_EQ(measure(Sectors{{0, 0}}, 0.5).note, "");
    EXPECT_EQ(measure(Sectors{{0, 0}}, 0).width, 1600u);
    const MapExtent bounded = measure(Sectors{{0, 0}}, 0.001);
    EXPECT_EQ(bounded.width, 7168u);
    EXPECT_EQ(
        bounded.note,
        "0.001 m a pixel would make 6.4e+04 pixels a side; the map is drawn at 0.008929 m a pixel, for the "
        "limit is 8,192 with the frame");
}

TEST(Canvas, TextIsDrawnWhereItIsSaidAndCutOff) {
    Image image(100, 40);
    write_text(image, 10, 10, "H", white, 2);
    const PixelRect letter = bounds_of(image, white);
    EXPECT_GE(letter.x0, 10);
    EXPECT_GE(letter.y0, 10);
    EXPECT_LE(letter.x1, 10 + text_width("H", 2));
    EXPECT_LE(letter.y1, 10 + text_height(2));
    write_text(image, -20, -5, "a text that goes on and on and on, with \xC3\xA4 in it", white, 3);
    write_text(image, 1000, 1000, "outside", white, 3);
    EXPECT_EQ(text_width("", 2), 0);
}

TEST(Canvas, RectanglesEndWhereTheySay) {
    Image image(20, 20);
    frame(image, {5, 6, 15, 16}, marker);
    const PixelRect bounds = bounds_of(image, marker);
    EXPECT_EQ(std::tuple(bounds.x0, bounds.y0, bounds.x1, bounds.y1), std::tuple(5, 6, 15, 16));
    EXPECT_EQ(image.at(7, 8)[0], 0);
    blend(image, {7, 8, 8, 9}, white, 0.5f);
    EXPECT_EQ(image.at(7, 8)[0], 128);
    fill(image, {-5, -5, 100, 3}, white);
    EXPECT_EQ(image.at(19, 2)[2], 255);
    EXPECT_EQ(image.at(19, 3)[2], 0);
}

TEST(PngFile, NamesThatCannotBeWrittenAreRefused) {
    const test::TemporaryFolder folder;
    for (const char* name : {"/a.jpg", "/a", "/a.png.txt"}) {
        const auto checked = check_png_target(folder.path() + name);
        ASSERT_FALSE(checked) << name;
        EXPECT_EQ(checked.error().code, cli::exit_usage);
        EXPECT_NE(checked.error().sentence.find(".png"), std::string::npos) << checked.error().sentence;
    }
    EXPECT_TRUE(check_png_target(folder.path() + "/a.PNG"));
    EXPECT_EQ(check_png_target(folder.path() + "/no/a.png").error().code, cli::exit_unreadable);
    test::write_file(folder.path() + "/b.png", "a text");
    EXPECT_FALSE(check_png_target(folder.path() + "/b.png"));
}

}  // namespace
}  // namespace drtv::image
