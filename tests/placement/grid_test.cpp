// The 16 x 16 x 16 grid against a brute-force search.
#include "placement/grid.h"
#include "tests/placement/analytic_scene.h"

#include <gtest/gtest.h>

#include <random>

namespace drtv::test {
namespace {

using placement::ProbeGrid;
using Sees = std::function<bool(const glm::vec3&, const glm::vec3&)>;

ProbeGrid build(std::int32_t i, std::int32_t j, const std::vector<Position>& probes, const Sees& sees) {
    placement::Surroundings surroundings;
    surroundings.sees = sees;
    return placement::build_grid(i, j, probes, surroundings);
}

// Cell by cell: of the four nearest by (distance, index) the first that is seen, else the nearest.
void expect_brute_force(std::int32_t i, std::int32_t j, const std::vector<Position>& probes,
                        const Sees& sees) {
    const ProbeGrid grid = build(i, j, probes, sees);
    const std::int32_t height = static_cast<std::int32_t>(grid.cell_height_units);
    int wrong = 0;
    for (int n = 0; n < 4096; ++n) {
        const Position centre(i * 65536 + (n % 16) * 4096 + 2048, j * 65536 + (n / 16 % 16) * 4096 + 2048,
                              grid.z_origin_units + (n / 256) * height + height / 2);
        std::vector<std::pair<std::int64_t, int>> order;
        for (std::size_t p = 0; p < probes.size(); ++p)
            order.emplace_back(squared_distance(centre, probes[p]), static_cast<int>(p));
        std::sort(order.begin(), order.end());
        int expected = order[0].second;
        for (std::size_t k = 0; k < std::min<std::size_t>(4, order.size()); ++k) {
            if (!sees(placement::metres(centre),
                      placement::metres(probes[static_cast<std::size_t>(order[k].second)])))
                continue;
            expected = order[k].second;
            break;
        }
        wrong += grid.cells[static_cast<std::size_t>(n)] != expected ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0) << probes.size() << " probes in sector " << i << ", " << j;
}

bool everything(const glm::vec3&, const glm::vec3&) {
    return true;
}
bool nothing(const glm::vec3&, const glm::vec3&) {
    return false;
}
// A wall at x = 20 (modulo the sector), and a floor at z = 3.
bool past_a_wall(const glm::vec3& a, const glm::vec3& b) {
    return (a.x < 20) == (b.x < 20) && (a.z < 3) == (b.z < 3);
}

TEST(ProbeGrid, AgreesWithBruteForce) {
    std::mt19937 random(11);
    for (const std::size_t count : {1u, 2u, 3u, 5u, 40u, 255u}) {
        for (const auto& [i, j] : {std::pair{0, 0}, {-2, 3}}) {
            std::vector<Position> probes;
            for (std::size_t n = 0; n < count; ++n)
                probes.emplace_back(i * 65536 + static_cast<int>(random() % 65536u),
                                    j * 65536 + static_cast<int>(random() % 65536u),
                                    static_cast<int>(random() % 20000u) - 5000);
            expect_brute_force(i, j, probes, everything);
            expect_brute_force(i, j, probes, nothing);
            expect_brute_force(i, j, probes, past_a_wall);
        }
    }
}

TEST(ProbeGrid, TiesGoToTheSmallerIndex) {
    std::vector<Position> probes;  // on cell corners: four to eight equal distances everywhere
    for (int y = 0; y <= 14; ++y) {
        for (int x = 0; x <= 14; ++x)
            probes.emplace_back(x * 4096 + 4096, y * 4096 + 4096, (x * y) % 2 * 4096);
    }
    std::mt19937 random(3);
    for (int n = 0; n < 3; ++n) {
        expect_brute_force(0, 0, probes, everything);
        expect_brute_force(0, 0, probes, past_a_wall);
        std::shuffle(probes.begin(), probes.end(), random);
    }
}

TEST(ProbeGrid, AllProbesAtOnePlaceGoToTheFirst) {
    const ProbeGrid grid = build(0, 0, std::vector<Position>(255, Position(5, 5, 5)), everything);
    EXPECT_TRUE(std::all_of(grid.cells.begin(), grid.cells.end(), [](std::uint8_t c) { return c == 0; }));
}

TEST(ProbeGrid, CellPrefersAProbeItsCentreSees) {
    // The nearest stands behind the wall at x = 20.
    const std::vector<Position> probes = {{20 * 1024 + 512, 2048, 1024}, {10 * 1024, 2048, 1024}};
    const ProbeGrid grid = build(0, 0, probes, past_a_wall);
    const auto low = static_cast<std::size_t>((1024 - grid.z_origin_units) /
                                              static_cast<std::int32_t>(grid.cell_height_units));
    EXPECT_EQ(grid.cells[4 + 256 * low], 1);  // x from 16 to 20
    EXPECT_EQ(grid.cells[5 + 256 * low], 0);
    EXPECT_EQ(build(0, 0, probes, everything).cells[4 + 256 * low], 0);
}

TEST(ProbeGrid, NoProbesGiveAGridOfNone) {
    const ProbeGrid grid = build(0, 0, {}, everything);
    EXPECT_TRUE(std::all_of(grid.cells.begin(), grid.cells.end(),
                            [](std::uint8_t c) { return c == placement::no_probe; }));
}

TEST(ProbeGrid, AllProbesLieInsideItsHeight) {
    const std::vector<Position> probes = {{100, 100, -7777}, {200, 200, 543210}};
    const ProbeGrid grid = build(0, 0, probes, everything);
    EXPECT_LE(grid.z_origin_units, -7777);
    EXPECT_GE(grid.z_origin_units + 16 * std::int64_t{grid.cell_height_units}, 543210);
    expect_brute_force(0, 0, probes, everything);
}

}  // namespace
}  // namespace drtv::test
