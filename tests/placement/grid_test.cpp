// The 16 x 16 x 16 grid against a brute-force search.
#include "placement/grid.h"
#include "tests/placement/analytic_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace drtv::test {
namespace {

using placement::ProbeGrid;
using Sees = std::function<bool(const glm::vec3&, const glm::vec3&)>;

std::vector<placement::GridProbe> grid_probes(const std::vector<Position>& positions) {
    std::vector<placement::GridProbe> probes;
    for (const Position& position : positions)
        probes.push_back({position, {}});
    return probes;
}

// Empty space but for what hides.
placement::SceneQueries space(const Sees& sees) {
    placement::SceneQueries queries;
    queries.column_of_spaces = [](glm::vec2, std::vector<ColumnHit>& hits) { hits.clear(); };
    queries.closed_around = [](const glm::vec3&) { return std::optional<placement::Thing>(); };
    queries.first_met = [](const glm::vec3&, std::span<const placement::Look>, std::size_t) {
        return placement::Met{0, 1, std::nullopt};
    };
    queries.hidden = [sees](const glm::vec3& a, const glm::vec3& b) { return !sees(a, b); };
    queries.separated = queries.hidden;
    return queries;
}

ProbeGrid build(std::int32_t i, std::int32_t j, const std::vector<Position>& probes, const Sees& sees) {
    return placement::build_grid(i, j, grid_probes(probes), space(sees));
}

std::size_t cell_at(const ProbeGrid& grid, const glm::vec3& point) {
    const auto height = static_cast<float>(grid.cell_height_units) / 1024;
    const auto z =
        static_cast<std::size_t>((point.z - static_cast<float>(grid.z_origin_units) / 1024) / height);
    return static_cast<std::size_t>(point.x / 4) + 16 * static_cast<std::size_t>(point.y / 4) + 256 * z;
}

// The nearest, by distance from the centre and index, that at least two of the four points see, else the one
// that most see, else the nearest.
int expected_for(int cell, const ProbeGrid& grid, std::int32_t i, std::int32_t j,
                 const std::vector<Position>& probes, const Sees& sees) {
    const std::int32_t height = static_cast<std::int32_t>(grid.cell_height_units);
    const Position corner(i * 65536 + (cell % 16) * 4096, j * 65536 + (cell / 16 % 16) * 4096,
                          grid.z_origin_units + (cell / 256) * height);
    std::array<Position, 4> points = {Position(1024, 1024, height / 4),
                                      {3072, 3072, height / 4},
                                      {3072, 1024, height - height / 4},
                                      {1024, 3072, height - height / 4}};
    std::vector<std::tuple<std::int64_t, int>> order;
    for (std::size_t p = 0; p < probes.size(); ++p)
        order.emplace_back(squared_distance(corner + Position(2048, 2048, height / 2), probes[p]),
                           static_cast<int>(p));
    std::sort(order.begin(), order.end());
    int best = std::get<1>(order[0]);
    auto most = std::ptrdiff_t{0};
    for (const auto& [distance, p] : order) {
        const auto seeing = std::count_if(points.begin(), points.end(), [&](const Position& point) {
            return sees(placement::metres(corner + point),
                        placement::metres(probes[static_cast<std::size_t>(p)]));
        });
        if (seeing >= 2)
            return p;
        if (seeing > most) {
            most = seeing;
            best = p;
        }
    }
    return best;
}

void expect_brute_force(std::int32_t i, std::int32_t j, const std::vector<Position>& probes,
                        const Sees& sees) {
    const ProbeGrid grid = build(i, j, probes, sees);
    int wrong = 0;
    for (int n = 0; n < 4096; ++n)
        wrong += grid.cells[static_cast<std::size_t>(n)] != expected_for(n, grid, i, j, probes, sees) ? 1 : 0;
    EXPECT_EQ(wrong, 0) << probes.size() << " probes in sector " << i << ", " << j;
}

bool everything(const glm::vec3&, const glm::vec3&) {
    return true;
}
bool nothing(const glm::vec3&, const glm::vec3&) {
    return false;
}
// A wall at x = 21 (modulo the sector), through the middle of no cell and the quarter of one, and a floor.
bool past_a_wall(const glm::vec3& a, const glm::vec3& b) {
    return (a.x < 21.5f) == (b.x < 21.5f) && (a.z < 3) == (b.z < 3);
}
// Every place sees a third of the others.
bool at_random(const glm::vec3& a, const glm::vec3& b) {
    return static_cast<int>(std::floor(a.x * 7 + a.y * 13 + a.z * 29 + b.x * 31 + b.y * 37 + b.z * 41)) % 3 ==
           0;
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
            expect_brute_force(i, j, probes, at_random);
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

TEST(ProbeGrid, EveryProbeIsAskedNotTheNearestFour) {
    // Five stand behind the wall, and the one on this side far away.
    std::vector<Position> probes(5, Position(24 * 1024, 2048, 1024));
    probes.emplace_back(2048, 60 * 1024, 1024);
    const ProbeGrid grid = build(0, 0, probes, past_a_wall);
    EXPECT_EQ(grid.cells[cell_at(grid, {18, 2, 1})], 5);
    EXPECT_EQ(grid.cells[cell_at(grid, {26, 2, 1})], 0);
}

TEST(ProbeGrid, CellsThatSeeNoneAreCounted) {
    const std::vector<Position> probes = {{2048, 2048, 1024}};
    EXPECT_EQ(build(0, 0, probes, nothing).blind_cells, 4096u);
    EXPECT_EQ(build(0, 0, probes, everything).blind_cells, 0u);
    EXPECT_EQ(build(0, 0, probes, everything).buried_cells, 0u);
}

TEST(ProbeGrid, ACellThatSeesNoneTakesOneOfItsOwnSpace) {
    // Leaves everywhere hide all; the wall separates.
    placement::SceneQueries queries = space(nothing);
    queries.separated = [](const glm::vec3& a, const glm::vec3& b) { return !past_a_wall(a, b); };
    const ProbeGrid grid =
        placement::build_grid(0, 0, grid_probes({{22 * 1024, 2048, 1024}, {2048, 60 * 1024, 1024}}), queries);
    EXPECT_EQ(grid.cells[cell_at(grid, {18, 2, 1})], 1);
    EXPECT_EQ(grid.blind_cells, 4096u);
}

// Ground at z = 3.8, its front up, west of a cliff at x = 32; east of it is nothing. A wall at x = 4.
placement::SceneQueries ground_and_wall() {
    const auto over_ground = [](const glm::vec3& p) { return p.x >= 32 || p.z >= 3.8f; };
    placement::SceneQueries queries = space([over_ground](const glm::vec3& a, const glm::vec3& b) {
        return over_ground(a) == over_ground(b) && (a.x < 4) == (b.x < 4);
    });
    queries.column_of_spaces = [](glm::vec2 at, std::vector<ColumnHit>& hits) {
        hits.clear();
        if (at.x < 32)
            hits.push_back({3.8f, true, false, true, false});
    };
    return queries;
}

TEST(ProbeGrid, APointInTheGroundIsRaisedToItsSurface) {
    const ProbeGrid grid =
        placement::build_grid(0, 0, grid_probes({{4200, 2048, 5000}, {100, 100, 5000}}), ground_and_wall());
    EXPECT_EQ(grid.cells[cell_at(grid, {2, 2, 3.85f})], 1) << "of its cell a tenth is over the ground";
    EXPECT_EQ(grid.buried_cells, 0u);
    EXPECT_EQ(grid.blind_cells, 0u);
}

TEST(ProbeGrid, CellsUnderTheGroundAreCountedAndAskedWhereAProbeStandsThere) {
    std::vector<Position> probes = {{4200, 2048, 5000}, {100, 100, 5000}, {60 * 1024, 2048, 1000}};
    const ProbeGrid sealed = placement::build_grid(0, 0, grid_probes(probes), ground_and_wall());
    EXPECT_GT(sealed.buried_cells, 256u);
    EXPECT_EQ(sealed.blind_cells, 0u);
    probes.emplace_back(100, 100, 1000);
    const ProbeGrid open = placement::build_grid(0, 0, grid_probes(probes), ground_and_wall());
    EXPECT_LT(open.buried_cells, sealed.buried_cells);
    EXPECT_EQ(open.cells[cell_at(open, {2, 2, 0.2f})], 3);
}

TEST(ProbeGrid, AnInteriorsProbeIsNamedInsideOfItAlone) {
    const placement::ClosedVolume house = box_volume({8, 8, -9}, {20, 20, 9});
    std::vector<placement::GridProbe> probes =
        grid_probes({{14 * 1024, 14 * 1024, 1024}, {50 * 1024, 50 * 1024, 1024}});
    probes[0].interiors = {&house};
    const ProbeGrid grid = placement::build_grid(0, 0, probes, space(everything));
    EXPECT_EQ(grid.cells[cell_at(grid, {14, 14, 1})], 0);
    EXPECT_EQ(grid.cells[cell_at(grid, {6, 14, 1})], 1);
    EXPECT_EQ(grid.cells[cell_at(grid, {22, 14, 1})], 1);
    probes.pop_back();
    const ProbeGrid alone = placement::build_grid(0, 0, probes, space(everything));
    EXPECT_EQ(alone.cells[cell_at(alone, {14, 14, 1})], 0);
    EXPECT_EQ(alone.cells[cell_at(alone, {6, 14, 1})], no_probe) << "nothing lights it";
}

TEST(ProbeGrid, NoProbesGiveAGridOfNone) {
    const ProbeGrid grid = build(0, 0, {}, everything);
    EXPECT_TRUE(
        std::all_of(grid.cells.begin(), grid.cells.end(), [](std::uint8_t c) { return c == no_probe; }));
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
