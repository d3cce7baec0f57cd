// What the map takes of the C library must not show in a bake: its functions differ in their last bits.
#include "bakerd/map/cos_sin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

namespace drtv::test {
namespace {

TEST(CosSin, AgreesWithTheCLibraryInAllButTheLastBits) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> near(-4, 4), far(-6000, 6000);
    for (int n = 0; n < 200000; ++n) {
        const double x = n % 2 == 0 ? near(random) : far(random);
        const glm::dvec2 found = map::cos_sin(x);
        ASSERT_NEAR(found.x, std::cos(x), 4e-16) << x;
        ASSERT_NEAR(found.y, std::sin(x), 4e-16) << x;
    }
}

TEST(CosSin, IsExactWhereItCanBe) {
    EXPECT_EQ(map::cos_sin(0), glm::dvec2(1, 0));
    EXPECT_EQ(map::cos_sin(-0.0), glm::dvec2(1, 0));
    EXPECT_NEAR(map::cos_sin(1.5707963267948966).x, 6.123233995736766e-17, 1e-30);
    EXPECT_EQ(map::cos_sin(1.5707963267948966).y, 1);
}

// The table of sRGB comes from the C library's power, in double, and is rounded to float: no entry lies so
// near to a tie that an error of that power of a hundred times its last bit would show.
TEST(LinearFromSrgb, IsTheSameWithEveryCLibrary) {
    for (int n = 0; n < 256; ++n) {
        const double s = n / 255.0, linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
        EXPECT_EQ(static_cast<float>(linear * (1 + 2e-14)), static_cast<float>(linear)) << n;
        EXPECT_EQ(static_cast<float>(linear * (1 - 2e-14)), static_cast<float>(linear)) << n;
    }
}

}  // namespace
}  // namespace drtv::test
