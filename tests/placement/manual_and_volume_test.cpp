// Manual probes stay and win; no_probes volumes remove automatic ones; the order of neither matters.
#include "tests/placement/analytic_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace drtv::test {
namespace {

TEST(ManualProbe, StaysExactlyWhereItIsAndWins) {
    AnalyticScene scene = flat_ground();
    scene.boxes = {{{30, 30, -2}, {40, 40, 20}}};
    scene.no_probes = {box_volume({0, 0, -10}, {64, 64, 100})};
    // In a solid, in a volume, nearer than the minimal distance to each other: all no matter.
    scene.manual =
        manual_at({{35.25, 35.5, 4}, {35.25, 35.5, 4.125}, {5 + 1.0 / 1024, 6, 1}, {63.9990234375, 0, 1}});
    const placement::Placement placed = scene.place(0, 0);
    ASSERT_EQ(placed.probes.size(), 4u);
    for (const placement::HandPlacedProbe& m : scene.manual) {
        EXPECT_TRUE(std::any_of(placed.probes.begin(), placed.probes.end(), [&](const PlacedProbe& p) {
            return p.kind == Kind::manual && glm::dvec3(p.position) == m.position * 1024.0;
        }));
    }
}

TEST(ManualProbe, KeepsAutomaticOnesAwayAcrossTheBorder) {
    AnalyticScene scene = flat_ground();
    scene.manual = manual_at({{64, 10, 1}});  // on the border: belongs to sector (1, 0)
    const placement::Placement left = scene.place(0, 0), right = scene.place(1, 0);
    EXPECT_EQ(count_of(left, Kind::manual), 0u);
    EXPECT_EQ(count_of(right, Kind::manual), 1u);
    EXPECT_EQ(right.probes[0].kind, Kind::manual) << "manual ones come first";
    std::vector<PlacedProbe> both = left.probes;
    both.insert(both.end(), right.probes.begin(), right.probes.end());
    EXPECT_GE(min_squared_distance(both), squared_units(6));
}

TEST(NoProbesVolume, RemovesWhatIsInsideAndCounts) {
    AnalyticScene scene = flat_ground();
    scene.no_probes = {box_volume({0, 0, 0.5}, {32, 64, 1.5})};
    const placement::Placement placed = scene.place(0, 0);
    EXPECT_EQ(placed.report.removed_by_volume, 128u);
    EXPECT_FALSE(placed.probes.empty());
    for (const PlacedProbe& p : placed.probes)
        EXPECT_GT(p.position.x, 32 * 1024);
    scene.no_probes = {box_volume({0, 0, 1.5}, {32, 64, 9})};
    EXPECT_EQ(scene.place(0, 0).report.removed_by_volume, 0u) << "above the probes";
}

TEST(NoProbesVolume, RemovedProbeTakesNoPlaceFromAnother) {
    AnalyticScene scene = flat_ground();
    // The four of the first class around the column at (14, 14).
    for (const glm::dvec3& at :
         {glm::dvec3(10, 10, 1), glm::dvec3(18, 10, 1), glm::dvec3(10, 18, 1), glm::dvec3(18, 18, 1)})
        scene.no_probes.push_back(box_volume(at - 1.0, at + 1.0));
    const placement::Placement placed = scene.place(0, 0);
    EXPECT_TRUE(std::any_of(placed.probes.begin(), placed.probes.end(),
                            [](const PlacedProbe& p) { return p.position == Position(14, 14, 1) * 1024; }));
}

TEST(Placement, OrderOfInputsIsIrrelevant) {
    AnalyticScene scene = flat_ground();
    std::mt19937 random(5);
    const auto uniform = [&](double most) { return most * static_cast<double>(random() % 4096u) / 4096.0; };
    for (int n = 0; n < 40; ++n) {
        scene.manual.push_back({{uniform(64), uniform(64), uniform(9)}, {}});
        const glm::vec3 low(uniform(60), uniform(60), uniform(6));
        scene.vegetation.push_back({low, low + glm::vec3(9, 9, 12)});
        if (n % 8 == 0)
            scene.no_probes.push_back(box_volume(glm::dvec3(low), glm::dvec3(low) + 7.0));
    }
    scene.manual.push_back(scene.manual[3]);  // the same twice is one
    const std::vector<ProbeKey> before = keys(scene.place(0, 0).probes);
    for (int n = 0; n < 5; ++n) {
        std::shuffle(scene.manual.begin(), scene.manual.end(), random);
        std::shuffle(scene.vegetation.begin(), scene.vegetation.end(), random);
        std::shuffle(scene.no_probes.begin(), scene.no_probes.end(), random);
        EXPECT_EQ(keys(scene.place(0, 0).probes), before);
    }
    EXPECT_EQ(static_cast<std::size_t>(std::count_if(before.begin(), before.end(),
                                                     [](const ProbeKey& k) { return std::get<3>(k) == 2; })),
              40u);
}

TEST(Placement, ProbesStandManualFirstThenByRowAndColumn) {
    AnalyticScene scene = flat_ground();
    scene.manual = manual_at({{60, 60, 9}, {1, 1, 9}});
    const placement::Placement placed = scene.place(0, 0);
    const std::vector<ProbeKey> all = keys(placed.probes);
    EXPECT_EQ(count_of(placed, Kind::manual), 2u);
    EXPECT_EQ(placed.probes[1].kind, Kind::manual);
    EXPECT_TRUE(std::is_sorted(all.begin(), all.begin() + 2) && std::is_sorted(all.begin() + 2, all.end()));
}

}  // namespace
}  // namespace drtv::test
