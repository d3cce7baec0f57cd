// When a day has gone on far enough to relight (slide 35 of the talk).
#include "tests/runtime/sets.h"

#include <drtv/day.h>
#include <drtv/relight.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace drtv {
namespace {

constexpr float scale = 16;  // of a clear day's volume
constexpr float half_code = scale / 510;

Sector field() {
    Sector sector = test::lattice_sector({0, 0}, 4, 2);
    test::put_on_plane(sector, {0.2f, 0.3f, 0.1f});
    return sector;
}

SceneLight light_at(double hour) {
    return light_of_day(default_day(), hour, RelightMode::accurate, {});
}

TEST(RelightNeeded, SaysSoBeforeACodeIsMissed) {
    test::OwnedSet set;
    const SectorView& sector = set.add(field()).view;
    SceneLight shown = light_at(0);
    int relights = 0;
    constexpr int minutes = 24 * 60;
    for (int minute = 0; minute < minutes; ++minute) {
        const SceneLight now = light_at(minute / 60.0);
        float largest = 0;
        for (std::size_t p = 0; p < sector.probe_count; ++p) {
            const BasisColours before = clamped(relight(sector, p, shown));
            const BasisColours after = clamped(relight(sector, p, now));
            for (std::size_t b = 0; b < basis_count; ++b) {
                for (std::size_t c = 0; c < channel_count; ++c)
                    largest = std::max(largest, std::abs(before[b][c] - after[b][c]));
            }
        }
        const bool needed = relight_needed(sector, shown, now, half_code);
        constexpr float packing = scale / 2048;
        EXPECT_TRUE(needed || largest <= half_code + packing) << minute;
        EXPECT_TRUE(!needed || largest > half_code - packing || minute == 0) << minute;
        if (needed) {
            shown = now;
            ++relights;
        }
        EXPECT_TRUE(minute >= 4 * 60 || relights == 0) << "at night nothing changes";
    }
    EXPECT_GT(relights, 50);
    EXPECT_LT(relights, minutes / 2);
}

TEST(RelightNeeded, SeesEveryKindOfLight) {
    test::OwnedSet set;
    Sector with_lamps = field();
    with_lamps.static_irradiance.assign(with_lamps.probes.size(), {{{{1000, 0, 0, 0}, {}, {}}}, 0});
    with_lamps.light_groups = {{"lanterns", with_lamps.static_irradiance}};
    const SectorView& sector = set.add(with_lamps).view;
    const SceneLight shown = light_at(12);
    EXPECT_FALSE(relight_needed(sector, shown, shown, 0));
    SceneLight now = shown;
    now.static_colour[0] = 3;  // 1000 codes are 0.03
    EXPECT_TRUE(relight_needed(sector, shown, now, half_code));
    now = shown;
    now.sun.irradiance[1] *= 1.2f;
    EXPECT_TRUE(relight_needed(sector, shown, now, half_code));
    // Two lights with lists of their own.
    const std::array<GroupColour, 1> dim = {{{"lanterns", {0.1f, 0.1f, 0.1f}}}};
    const std::array<GroupColour, 1> bright = {{{"lanterns", {9, 9, 9}}}};
    SceneLight lanterns = shown;
    lanterns.groups = dim;
    now = shown;
    now.groups = bright;
    EXPECT_TRUE(relight_needed(sector, lanterns, now, half_code));
    now.groups = {};
    now.other_groups = {9, 9, 9};
    EXPECT_TRUE(relight_needed(sector, lanterns, now, half_code));
    now = shown;
    now.sky[2][0] += 1;
    EXPECT_TRUE(relight_needed(sector, shown, now, half_code));
    now = shown;
    now.mode = RelightMode::literal;
    EXPECT_TRUE(relight_needed(sector, shown, now, half_code));
    now = shown;
    now.sky[2][0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(relight_needed(sector, shown, now, half_code));
    // Where a sector has no probes, its texels show the open sky.
    test::OwnedSet empty;
    Sector bare = field();
    bare.probes.clear();
    bare.grid.cells.fill(no_probe);
    EXPECT_TRUE(relight_needed(empty.add(bare).view, shown, light_at(11), half_code));
    EXPECT_FALSE(relight_needed(empty->find({0, 0})->view, shown, shown, half_code));
}

}  // namespace
}  // namespace drtv
