// What passes walls of 0.2 m, in and out of a house of two rooms: one has a window, the other is closed. From
// it come the offset at which surfaces ask (surface_offset_m) and how far interiors should reach.
#include "tests/ambient/baked_map.h"
#include "tests/ambient/moments.h"
#include "tests/ambient/scenes.h"
#include "tests/reference/reference_ambient.h"

#include <drtv/ambient.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>
#include <tuple>
#include <vector>

namespace drtv::test {
namespace {

struct SurfacePoint {
    glm::vec3 at{};
    glm::vec3 normal{};
};

// On the sides of a box, a millimetre off them.
std::vector<SurfacePoint> points_on(const glm::vec3& low, const glm::vec3& high, bool inwards) {
    constexpr int per_side = 6;
    constexpr float off_m = 0.001f;
    std::vector<SurfacePoint> points;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        for (const bool upper : {false, true}) {
            glm::vec3 normal(0);
            normal[axis] = upper == inwards ? -1.0f : 1.0f;
            for (int n = 0; n < per_side * per_side; ++n) {
                glm::vec3 share(upper ? 1.0f : 0.0f);
                share[(axis + 1) % 3] = (static_cast<float>(n % per_side) + 0.5f) / per_side;
                share[(axis + 2) % 3] = (static_cast<float>(n / per_side) + 0.5f) / per_side;
                points.push_back({low + (high - low) * share + off_m * normal, normal});
            }
        }
    }
    return points;
}

AmbientPlace place_at(const SurfacePoint& point, Sampling sampling, float offset_m) {
    return {.at = {point.at.x, point.at.y, point.at.z},
            .normal = {point.normal.x, point.normal.y, point.normal.z},
            .sampling = sampling,
            .offset_m = offset_m};
}

TestMoment noon() {
    return moment_of({.zenith = {1, 1, 1}, .horizon = {1, 1, 1}}, glm::dvec3(9), {1, -1, 2});
}

// The house stands differently to the grid's cells of 4 m each time.
std::vector<TwoRoomsSettings> houses(const TwoRoomsSettings& house) {
    constexpr int count = 4;
    std::vector<TwoRoomsSettings> all(count, house);
    for (int n = 0; n < count; ++n) {
        const float shift_m = 4.0f * static_cast<float>(n) / count;
        all[static_cast<std::size_t>(n)].shift_m = {shift_m, 0.3f + shift_m / 2, 0};
    }
    return all;
}

settings::BakeSettings quick() {
    settings::BakeSettings settings;
    settings.rays = 256;
    settings.min_distance_m = 3;
    settings.local_transfer = true;
    return settings;
}

constexpr std::array<float, 4> offsets_m = {0, 0.5f, 1, 2};

// What reaches the dark room, over what reaches the one with the window or the lamp: [sampling][offset].
struct Leaks {
    using Table = std::array<std::array<double, offsets_m.size()>, 2>;
    Table daylight{};
    Table lamp{};
};

Leaks leaks(const TwoRoomsSettings& house) {
    struct Sums {
        double west = 0;
        double east = 0;
    };
    using Table = std::array<std::array<Sums, offsets_m.size()>, 2>;
    Table daylight{};
    Table lamp{};
    const SceneLight day = noon().light;
    for (const TwoRoomsSettings& shifted : houses(house)) {
        const TwoRooms rooms = two_rooms(shifted);
        const BakedMap map(rooms.source.b, quick(), {{0, 0}});
        const glm::vec3 middle = (rooms.west_low + rooms.west_high) * 0.5f;
        std::array<LightShare, max_shares_per_light> shares;
        const PointLight light{{middle.x, middle.y, middle.z}, {1, 1, 1}};
        const std::span<const LightShare> lamps(shares.data(), split_light(map.set(), light, shares));
        for (const bool is_west : {true, false}) {
            const auto points = is_west ? points_on(rooms.west_low, rooms.west_high, true)
                                        : points_on(rooms.east_low, rooms.east_high, true);
            for (const SurfacePoint& point : points) {
                for (std::size_t s = 0; s < 2; ++s) {
                    for (std::size_t o = 0; o < offsets_m.size(); ++o) {
                        const auto sampling = static_cast<Sampling>(s);
                        const AmbientPlace place = place_at(point, sampling, offsets_m[o]);
                        const auto add = [&](Sums& sums, float found) {
                            (is_west ? sums.west : sums.east) += static_cast<double>(found);
                        };
                        add(daylight[s][o], ambient_at(map.set(), day, {}, place).colour[1]);
                        add(lamp[s][o], ambient_at(map.set(), {}, lamps, place).parts.local[1]);
                    }
                }
            }
        }
    }
    Leaks found;
    for (std::size_t s = 0; s < 2; ++s) {
        for (std::size_t o = 0; o < offsets_m.size(); ++o) {
            found.daylight[s][o] = daylight[s][o].east / daylight[s][o].west;
            found.lamp[s][o] = lamp[s][o].east / lamp[s][o].west;
        }
    }
    return found;
}

void print(const char* title, const Leaks& leaks) {
    for (std::size_t s = 0; s < 2; ++s) {
        std::printf("%s, %s:", title, s == 0 ? "nearest" : "trilinear");
        for (std::size_t o = 0; o < offsets_m.size(); ++o) {
            std::printf(" | %g m: %.1f %% of the day, %.1f %% of the lamp", static_cast<double>(offsets_m[o]),
                        100 * leaks.daylight[s][o], 100 * leaks.lamp[s][o]);
        }
        std::printf("\n");
    }
}

// Probes alone do not know walls: rooms of some cells leak, rooms of less than one have their neighbours'
// light.
TEST(Rooms, LeakLessTheFartherOffTheWallSurfacesAsk) {
    const Leaks found = leaks({});
    print("rooms of 7 m, without interiors", found);
    for (std::size_t s = 0; s < 2; ++s) {
        EXPECT_LT(found.daylight[s].back(), 0.9 * found.daylight[s].front());
        EXPECT_LT(found.lamp[s].back(), 0.6 * found.lamp[s].front());
    }
    EXPECT_LT(found.lamp[0][2], 0.1);
    const Leaks of_a_cell = leaks({.side_m = 2});
    print("rooms of 2 m, without interiors", of_a_cell);
    EXPECT_GT(of_a_cell.daylight[1][2], 0.8);
}

TEST(Rooms, WithInteriorsAsLargeAsTheFadeLeakNothing) {
    for (const float side_m : {7.0f, 2.0f}) {
        const Leaks found = leaks({.side_m = side_m, .interiors_reach_m = 0.5f});
        print(side_m > 2 ? "rooms of 7 m, with interiors" : "rooms of 2 m, with interiors", found);
        for (std::size_t s = 0; s < 2; ++s) {
            for (std::size_t o = 0; o < offsets_m.size() && offsets_m[o] <= surface_offset_m; ++o) {
                EXPECT_LT(found.daylight[s][o], 0.001);
                EXPECT_LT(found.lamp[s][o], 0.001);
            }
        }
    }
    const Leaks short_of_it = leaks({.interiors_reach_m = 0.1f});
    print("rooms of 7 m, with interiors to the middle of the walls", short_of_it);
    EXPECT_LT(short_of_it.daylight[1][2], 0.5);
    EXPECT_LT(short_of_it.lamp[1][2], 0.001);
}

// On the outer walls and the roof: `error` is the mean, `darkest` the least of found over true.
struct Outside {
    double error = 0;
    double darkest = 1;
};

// [interiors off, on][offset]
std::array<std::array<Outside, offsets_m.size()>, 2> outside(const TwoRoomsSettings& house) {
    std::array<std::array<Outside, offsets_m.size()>, 2> found{};
    double truth_sum = 0;
    const TestMoment moment = noon();
    for (const TwoRoomsSettings& shifted : houses(house)) {
        const TwoRooms rooms = two_rooms(shifted);
        const BakedMap map(rooms.source.b, quick(), {{0, 0}});
        const reference::Scene scene(map.map());
        for (const SurfacePoint& point : points_on(rooms.outer_low, rooms.outer_high, false)) {
            if (point.normal.z < 0)
                continue;
            const glm::dvec3 normal = point.normal;
            const auto truth =
                reference::ambient(scene, point.at, {&normal, 1}, {&moment.truth, 1}, {.strata = 16})[0][0]
                    .total()
                    .y;
            truth_sum += truth;
            for (std::size_t n = 0; n < 2 * offsets_m.size(); ++n) {
                const std::size_t o = n % offsets_m.size();
                AmbientPlace place = place_at(point, Sampling::trilinear, offsets_m[o]);
                place.interiors = n >= offsets_m.size();
                const auto colour =
                    static_cast<double>(ambient_at(map.set(), moment.light, {}, place).colour[1]);
                Outside& sums = found[place.interiors ? 1 : 0][o];
                sums.error += std::abs(colour - truth);
                sums.darkest = std::min(sums.darkest, colour / truth);
            }
        }
    }
    for (auto& row : found) {
        for (Outside& sums : row)
            sums.error /= truth_sum;
    }
    return found;
}

// The cells under a house name its rooms' probes, which are dark.
TEST(Rooms, DoNotDarkenTheOuterWalls) {
    const auto found = outside({.interiors_reach_m = 0.5f});
    for (std::size_t o = 0; o < offsets_m.size(); ++o) {
        const auto& [off, on] = std::tie(found[0][o], found[1][o]);
        std::printf("outer walls, %g m: error %.3f, darkest %.2f; interiors off: error %.3f, darkest %.2f\n",
                    static_cast<double>(offsets_m[o]), on.error, on.darkest, off.error, off.darkest);
        if (offsets_m[o] == surface_offset_m) {
            EXPECT_LT(on.error, 0.15);
            EXPECT_GT(on.darkest, 0.75);
        }
    }
}

}  // namespace
}  // namespace drtv::test
