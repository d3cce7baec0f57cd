#include "bakerd/picture/draw.h"

#include "format/image/canvas.h"
#include "tests/picture/yard.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <span>

namespace drtv::test {
namespace {

using picture::Camera;
using picture::Moment;
using picture::Painter;
using picture::Show;
using picture::Size;

constexpr Size size = {160, 90};

Camera over_the_yard() {
    return Camera::at({26, 2, 3}, {26, 32, 2}, 70, size);
}

image::Image drawn(Show show, int threads) {
    const auto light = morning();
    const Moment moment(baked_yard().set(), *light, {}, {26, 2, 3});
    const Camera camera = over_the_yard();
    const Painter painter(yard_scenery(), moment, camera, show);
    tbb::task_arena arena(threads);
    image::Image image(1, 1);
    arena.execute([&] { image = draw(painter, size, 0.1f, [](std::size_t) {}); });
    return image;
}

TEST(Draw, SameBytesForAnyNumberOfThreads) {
    for (const Show show : {Show::all, Show::ambient, Show::leaks, Show::probes}) {
        const image::Image one = drawn(show, 1);
        EXPECT_EQ(one.rgb, drawn(show, 4).rgb);
        // Something is to be seen.
        EXPECT_GT(*std::ranges::max_element(one.rgb), 60);
        EXPECT_LT(*std::ranges::min_element(one.rgb), 40);
    }
}

TEST(Draw, TheWallsAreRedAndBlueAndTheGroundGreen) {
    const image::Image image = drawn(Show::all, 2);
    const auto is_mostly = [&](std::size_t x, std::size_t y, std::size_t channel) {
        const std::uint8_t* pixel = image.at(x, y);
        for (std::size_t c = 0; c < 3; ++c) {
            if (c != channel && pixel[c] >= pixel[channel])
                return false;
        }
        return true;
    };
    EXPECT_TRUE(is_mostly(20, 45, 0));
    EXPECT_TRUE(is_mostly(140, 45, 2));
    EXPECT_TRUE(is_mostly(80, 85, 1));
}

TEST(Draw, CountsItsSteps) {
    const auto light = morning();
    const Moment moment(baked_yard().set(), *light, {}, {26, 2, 3});
    const Camera camera = over_the_yard();
    const Painter painter(yard_scenery(), moment, camera, Show::all);
    std::atomic<std::size_t> last = 0;
    (void)draw(painter, size, 0.1f, [&](std::size_t done) {
        std::size_t before = last;
        while (before < done && !last.compare_exchange_weak(before, done)) {
        }
    });
    EXPECT_EQ(last, draw_steps(Show::all, size));
    EXPECT_EQ(draw_steps(Show::leaks, size), size.height);
}

TEST(Caption, WritesInsideOfThePicture) {
    image::Image image(60, 30);
    image::write_caption(image, 4, 4, "06:30");
    EXPECT_GT(std::ranges::count(image.rgb, 235), 100);
    EXPECT_EQ(image.at(0, 0)[0], 0);
    // What does not fit is cut, and changes nothing elsewhere.
    const image::Image before = image;
    image::write_caption(image, 100, 100, "outside");
    EXPECT_EQ(image.rgb, before.rgb);
    image::write_caption(image, 50, 25, "a long text that goes on and on");
    EXPECT_TRUE(std::ranges::equal(std::span(before.rgb).first(25 * 60 * 3),
                                   std::span(image.rgb).first(25 * 60 * 3)));
}

}  // namespace
}  // namespace drtv::test
