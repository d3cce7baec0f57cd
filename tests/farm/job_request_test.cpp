#include "bakerd/farm/job_request.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace drtv::farm {
namespace {

using Sectors = std::vector<map::SectorCoordinate>;

// 5 x 5 sectors around (0, 0), by (j, i).
Sectors ground() {
    Sectors sectors;
    for (std::int32_t j = -2; j <= 2; ++j) {
        for (std::int32_t i = -2; i <= 2; ++i)
            sectors.push_back({i, j});
    }
    return sectors;
}

void expect_chosen(const JobRegion& region, Sectors expected) {
    auto chosen = sectors_of(region, ground());
    ASSERT_TRUE(chosen) << chosen.error().message;
    std::sort(chosen->begin(), chosen->end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(*chosen, expected);
}

void expect_refused(const JobRegion& region, const std::string& with) {
    const auto chosen = sectors_of(region, ground());
    ASSERT_FALSE(chosen) << with;
    EXPECT_EQ(chosen.error().code, store::ErrorCode::invalid_argument);
    EXPECT_NE(chosen.error().message.find(with), std::string::npos) << chosen.error().message;
}

TEST(SectorsOf, APointChoosesTheSectorItLiesIn) {
    expect_chosen({1, 1, 1, 1}, {{0, 0}});
    expect_chosen({-1, 1, -1, 1}, {{-1, 0}});
    expect_chosen({0, 0, 0, 0}, {{0, 0}});  // sectors are half open
    expect_chosen({64, -64, 64, -64}, {{1, -1}});
}

TEST(SectorsOf, ARegionTouchesWhatItsBorderLiesIn) {
    expect_chosen({0, 0, 63.999, 63.999}, {{0, 0}});
    expect_chosen({0, 0, 64, 63}, {{0, 0}, {1, 0}});
    expect_chosen({-0.001, 0, 1, 1}, {{-1, 0}, {0, 0}});
    EXPECT_EQ(sectors_of(JobRegion{-1e300, -1e300, 1e300, 1e300}, ground())->size(), 25u);
}

TEST(SectorsOf, WrongRegionsAreRefused) {
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < 4; ++n) {
        for (const double bad : {nan, infinity, -infinity}) {
            double bounds[4] = {0, 0, 1, 1};
            bounds[n] = bad;
            expect_refused({bounds[0], bounds[1], bounds[2], bounds[3]}, "not a number of metres");
        }
    }
    expect_refused({1, 0, 0, 1}, "is empty");
    expect_refused({0, 1, 1, 0}, "is empty");
    expect_refused({192, 0, 300, 1}, "touches no sector");
}

TEST(SectorsOf, WithoutARegionAllAreChosenEvenNone) {
    EXPECT_EQ(sectors_of(std::nullopt, ground())->size(), 25u);
    EXPECT_TRUE(sectors_of(std::nullopt, {})->empty());
}

TEST(SectorsOf, TilesOfEightComeAfterEachOther) {
    Sectors wide;
    for (std::int32_t j = -8; j < 8; ++j) {
        for (std::int32_t i = -8; i < 8; ++i)
            wide.push_back({i, j});
    }
    const auto chosen = sectors_of(std::nullopt, wide);
    ASSERT_EQ(chosen->size(), 256u);
    for (std::size_t n = 0; n < 256; ++n) {
        const map::SectorCoordinate first = (*chosen)[n / 64 * 64];
        EXPECT_EQ((*chosen)[n].i >> 3, first.i >> 3) << n;
        EXPECT_EQ((*chosen)[n].j >> 3, first.j >> 3) << n;
    }
    EXPECT_EQ(chosen->front(), (map::SectorCoordinate{-8, -8}));
}

}  // namespace
}  // namespace drtv::farm
