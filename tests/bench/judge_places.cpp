// Judges where the probes of baked files stand, and which cells name them, by rays and a rule of its own:
//   judge_places MAP.glb DIR
// A dark probe has no light at all. A place is in a solid when no ray of 256 into the upper half escapes, and
// six in seven of them meet something from behind. A cell is unseen when of its nine points none sees the
// probe that it names, although one of them is in no solid; it is a fault when one of them sees another
// probe.
#include "bakerd/bake/probe_encoding.h"
#include "bakerd/bake/probe_warnings.h"
#include "tests/bench/bench_world.h"

#include <drtv/read.h>
#include <drtv/sector.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

namespace drtv::bench {
namespace {

constexpr float reach_m = 512;

struct Judgement {
    std::size_t sectors = 0, probes = 0, dark = 0, dark_in_solid = 0, cells = 0, unseen = 0, seeing = 0,
                in_solid = 0;
};

std::vector<glm::vec3> directions() {
    std::mt19937 random(20261127);
    std::normal_distribution<float> normal;
    std::vector<glm::vec3> all;
    while (all.size() < 256) {
        const glm::vec3 v(normal(random), normal(random), normal(random));
        if (glm::length(v) > 0.1f && v.z != 0)
            all.push_back(glm::normalize(glm::vec3(v.x, v.y, std::abs(v.z))));
    }
    return all;
}

// Of the rays upward, those that meet backs; none when some escape.
double share_of_backs(const trace::Scene& scene, const glm::vec3& place) {
    static const std::vector<glm::vec3> all = directions();
    std::size_t backs = 0;
    for (const glm::vec3& direction : all) {
        const auto hit = scene.closest({place, direction, reach_m});
        if (!hit)
            return 0;
        backs += hit->front ? 0u : 1u;
    }
    return static_cast<double>(backs) / static_cast<double>(all.size());
}

bool is_in_solid(const trace::Scene& scene, const glm::vec3& place) {
    constexpr double least = 6.0 / 7;
    return share_of_backs(scene, place) >= least;
}

bool sees(const trace::Scene& scene, const glm::vec3& from, const glm::vec3& to) {
    const float way_m = glm::length(to - from);
    return way_m <= 0 || !scene.occluded({from, (to - from) / way_m, way_m});
}

void judge_cells(const trace::Scene& scene, const Sector& sector, const std::vector<glm::vec3>& places,
                 Judgement& judgement) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> share(0.02f, 0.98f);
    const float height = static_cast<float>(sector.grid.cell_height_units) / 1024;
    for (std::size_t cell = 0; cell < grid_cell_count; ++cell) {
        const std::uint8_t named = sector.grid.cells[cell];
        if (named >= places.size())
            continue;
        ++judgement.cells;
        const glm::vec3 low(
            64 * sector.i + 4 * static_cast<int>(cell % 16),
            64 * sector.j + 4 * static_cast<int>(cell / 16 % 16),
            static_cast<float>(sector.grid.z_origin_units) / 1024 + height * static_cast<float>(cell / 256));
        std::vector<glm::vec3> points;
        for (int n = 0; n < 9; ++n)
            points.push_back(low + glm::vec3(4 * share(random), 4 * share(random), height * share(random)));
        if (std::ranges::any_of(points, [&](const glm::vec3& p) { return sees(scene, p, places[named]); }))
            continue;
        if (std::ranges::all_of(points, [&](const glm::vec3& p) { return is_in_solid(scene, p); }))
            ++judgement.in_solid;
        else {
            ++judgement.unseen;
            const bool any = std::ranges::any_of(places, [&](const glm::vec3& place) {
                return std::ranges::any_of(points, [&](const glm::vec3& p) { return sees(scene, p, place); });
            });
            judgement.seeing += any ? 1u : 0u;
        }
    }
}

void judge(bake::World& world, const Sector& sector, Judgement& judgement) {
    const auto scene = world.scene_for({sector.i, sector.j}, reach_m);
    std::vector<glm::vec3> places;
    for (const Probe& probe : sector.probes) {
        const auto units = position_units(sector, probe);
        places.push_back(placement::metres({units[0], units[1], units[2]}));
    }
    ++judgement.sectors;
    judgement.probes += places.size();
    for (std::size_t p = 0; p < places.size(); ++p) {
        if (!bake::is_dark(sector, p))
            continue;
        ++judgement.dark;
        judgement.dark_in_solid += is_in_solid(*scene, places[p]) ? 1u : 0u;
        std::printf("  dark: probe %zu of sector (%d, %d) at (%.3f, %.3f, %.3f), %.0f %% backs above\n", p,
                    sector.i, sector.j, double{places[p].x}, double{places[p].y}, double{places[p].z},
                    100 * share_of_backs(*scene, places[p]));
    }
    judge_cells(*scene, sector, places, judgement);
}

}  // namespace
}  // namespace drtv::bench

int main(int argc, char** argv) {
    using namespace drtv;
    if (argc != 3) {
        std::fprintf(stderr, "usage: judge_places MAP.glb DIR\n");
        return 1;
    }
    const trace::FloatMode float_mode;
    const auto world = bench::open_world(argv[1]);
    if (!world)
        return 2;
    bench::Judgement judgement;
    for (const auto& entry : std::filesystem::directory_iterator(argv[2])) {
        std::ifstream file(entry.path(), std::ios::binary);
        const std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(file)), {});
        Sector sector;
        if (read_sector(bytes, sector).ok())
            bench::judge(*world, sector, judgement);
    }
    std::printf(
        "%zu sectors, %zu probes, %zu dark, %zu of these in solids; of %zu cells %zu do not "
        "see theirs, %zu of these see another, and %zu are in solids\n",
        judgement.sectors, judgement.probes, judgement.dark, judgement.dark_in_solid, judgement.cells,
        judgement.unseen, judgement.seeing, judgement.in_solid);
}
