// `accurate` beside `literal`, by the truth: the same bytes, 64 normals, twelve moments of a day. The table
// for real maps is ambient_check's.
#include "tests/ambient/baked_map.h"
#include "tests/ambient/judge_ambient.h"
#include "tests/ambient/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace drtv::test {
namespace {

double accurate_over_literal(const Judgement& judgement, const std::string& what = "") {
    return find(judgement.at_probes, "accurate" + what).median() /
           find(judgement.at_probes, "literal" + what).median();
}

settings::BakeSettings fine() {
    settings::BakeSettings settings;
    settings.rays = 4096;
    return settings;
}

Judgement judged(const BakedMap& map, const JudgeSettings& settings) {
    const reference::Scene scene(map.map());
    const Judgement judgement = judge_ambient(scene, map.set(), map.sectors(), twelve_moments(), settings);
    print(judgement);
    return judgement;
}

TEST(Modes, AccurateErrsLessOutdoors) {
    const TwoRooms rooms = two_rooms({});
    const BakedMap map(rooms.source.b, fine(), {{0, 0}});
    const Judgement judgement = judged(map, {.probes = 40, .surfaces = 40, .strata = 32});
    EXPECT_LT(accurate_over_literal(judgement), 0.7);
    // What the file says of the four directions, apart from what shading makes of it.
    EXPECT_LT(accurate_over_literal(judgement, ": stored colours at b"), 0.5);
    // Storage and shading add little to what shading alone costs.
    EXPECT_LT(find(judgement.at_probes, "accurate").median(),
              1.3 * find(judgement.at_probes, "accurate: true colours at b").median());
    EXPECT_LT(std::abs(find(judgement.at_probes, "accurate").bias), 0.05);
}

// At places of a lattice, by hand: a bake's own probes would be three.
TEST(Modes, AccurateErrsLessIndoors) {
    TwoRooms rooms = two_rooms({});
    for (int n = 0; n < 75; ++n) {
        const glm::vec3 step(n % 5, n / 5 % 5, n / 25);
        rooms.source.add_probe(rooms.west_low + glm::vec3(1.1f, 1.1f, 0.6f) +
                               step * glm::vec3(1.2f, 1.2f, 0.9f));
    }
    const BakedMap map(rooms.source.b, fine(), {{0, 0}});
    const Judgement judgement = judged(
        map, {.probes = 75, .surfaces = 40, .strata = 48, .low = rooms.west_low, .high = rooms.west_high});
    EXPECT_LT(accurate_over_literal(judgement), 0.9);
}

}  // namespace
}  // namespace drtv::test
