// Walks over baked sectors, over their borders and grids' tops, into holes and out of the window: nothing
// jumps. Not into interiors, whose light fades within a metre.
#include "tests/ambient/talk_scene.h"

#include <drtv/ambient.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace drtv::test {
namespace {

constexpr double step_m = 0.1;
constexpr double largest_step = 0.05;  // of the walk's largest colour

struct Walk {
    Double3 from{};
    Double3 to{};
};

SceneLight afternoon() {
    SceneLight light;
    light.sky = gradient_sky(
        {.zenith = {0.3f, 0.5f, 1}, .horizon = {0.6f, 0.7f, 0.9f}, .sun_side = {0.4f, 0.2f, 0}}, {1, 1, 2});
    light.sun = {{9, 8, 7}, {1, 1, 2}};
    return light;
}

// `hole`: of three sectors in a row the middle one is missing, but its tile is known.
void load_world(OwnedSet& set, bool hole) {
    for (const Sector& sector : baked_talk_scene().files())
        set.add(sector);
    EXPECT_EQ(hole && set->drop({1, 0}), hole);
    set->retire();
}

struct Seen {
    double change = 0;  // the largest within a step, over the largest colour
    double darkest = std::numeric_limits<double>::infinity();
};

Seen seen_on(const Walk& walk, const std::function<Float3(const Double3&)>& colour_at) {
    double length = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        length = std::hypot(length, walk.to[axis] - walk.from[axis]);
    double largest = 0;
    Seen seen;
    Float3 last{};
    for (int n = 0; n * step_m <= length; ++n) {
        Double3 at;
        for (std::size_t axis = 0; axis < 3; ++axis)
            at[axis] = walk.from[axis] + (walk.to[axis] - walk.from[axis]) * n * step_m / length;
        const Float3 now = colour_at(at);
        for (std::size_t c = 0; c < channel_count; ++c) {
            const auto value = static_cast<double>(now[c]);
            largest = std::max(largest, value);
            seen.darkest = std::min(seen.darkest, value);
            if (n > 0)
                seen.change = std::max(seen.change, std::abs(value - static_cast<double>(last[c])));
        }
        last = now;
    }
    seen.change /= largest;
    return seen;
}

// Past the walls and the hut, through the canopy, over all sectors' sides; down into the ground and up over
// the grids' tops.
const std::vector<Walk> walks = {
    {{-40, 31, 1.5}, {240, 31, 1.5}}, {{-40, 11, 1.2}, {240, 11, 1.2}}, {{20, -30, 2}, {200, 90, 2}},
    {{63.9, 50, 1}, {64.1, -50, 1}},  {{100, 30, -40}, {100, 30, 60}},  {{127.5, 30, -40}, {128.5, 40, 60}},
};
constexpr std::array<Float3, 3> normals = {{{0, 0, 1}, {0.8f, 0.6f, 0}, {0, -0.6f, -0.8f}}};

TEST(Walks, InAVolumeNeverJump) {
    const SceneLight light = afternoon();
    for (const bool hole : {false, true}) {
        OwnedSet set;
        load_world(set, hole);
        OwnedRelit relit(set->limits());
        relit->set_light(Shown::now, light);
        for (std::int32_t i = 0; i < 3; ++i) {
            if (const LoadedSector* sector = set->find({i, 0}))
                relit->relight(Shown::now, *sector, light, {});
        }
        VolumeSettings settings;
        settings.encoding = TexelEncoding::rgba16f;
        settings.size = {24, 24, 16};
        settings.outdoors = hole;
        for (const bool follows : {true, false}) {
            settings.outdoors = !settings.outdoors;  // each way once with a hole and once without
            OwnedVolume volume(settings, set->limits());
            volume->update(*set, *relit, {96, 32, 2});
            for (const Walk& walk : walks) {
                for (const Float3& normal : normals) {
                    const Seen seen = seen_on(walk, [&](const Double3& at) {
                        if (follows)
                            volume->update(*set, *relit, at);
                        AmbientPlace place;
                        place.at = at;
                        place.normal = normal;
                        place.interiors = false;
                        return ambient_in(*volume, *set, light, {}, place).colour;
                    });
                    EXPECT_LT(seen.change, largest_step)
                        << "hole " << hole << ", follows " << follows << ", from " << walk.from[0];
                    EXPECT_GT(seen.darkest, 0) << "black, from " << walk.from[0];
                }
            }
        }
    }
}

TEST(Walks, BetweenEightCellsNeverJump) {
    const SceneLight light = afternoon();
    for (const bool hole : {false, true}) {
        OwnedSet set;
        load_world(set, hole);
        double by_nearest = 0;
        for (const Walk& walk : walks) {
            for (const Float3& normal : normals) {
                const auto seen_by = [&](Sampling sampling) {
                    return seen_on(walk, [&](const Double3& at) {
                        AmbientPlace place;
                        place.at = at;
                        place.normal = normal;
                        place.sampling = sampling;
                        place.interiors = false;
                        return ambient_at(*set, light, {}, place).colour;
                    });
                };
                const Seen seen = seen_by(Sampling::trilinear);
                EXPECT_LT(seen.change, largest_step) << "hole " << hole << ", from " << walk.from[0];
                EXPECT_GT(seen.darkest, 0) << "black, from " << walk.from[0];
                by_nearest = std::max(by_nearest, seen_by(Sampling::nearest).change);
            }
        }
        EXPECT_GT(by_nearest, 4 * largest_step) << "what it is for";
    }
}

}  // namespace
}  // namespace drtv::test
