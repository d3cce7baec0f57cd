// What placement and the grid cost beside the bake of a sector, and what they give:
//   placement_bench MAP.glb [SECTORS]
// One thread; sectors spread over the map.
#include "bakerd/bake/placement_scene.h"
#include "bakerd/bake/sector_bake.h"
#include "placement/grid.h"
#include "tests/bench/bench_world.h"

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace drtv::bench {
namespace {

struct Totals {
    double place_s = 0, grid_s = 0, bake_s = 0;
    std::size_t probes = 0, candidates = 0, moved = 0, dropped = 0, buried_cells = 0, blind_cells = 0;
};

void add_sector(bake::World& world, map::SectorCoordinate sector, const settings::BakeSettings& settings,
                Totals& totals) {
    const auto around = world.surroundings(sector, settings);
    const double start = seconds();
    const auto placed = world.placed(sector, settings, *around.scene);
    const double placed_at = seconds();
    totals.place_s += placed_at - start;
    if (!*placed)
        return;
    std::vector<placement::GridProbe> probes;
    for (const placement::Position& position : (*placed)->positions)
        probes.push_back({position, {}});
    const placement::ProbeGrid grid =
        placement::build_grid(sector.i, sector.j, probes, bake::queries_of(*around.scene, settings.reach_m));
    const double indexed_at = seconds();
    totals.grid_s += indexed_at - placed_at;
    const auto baked = bake::bake_sector(world, sector, settings);
    totals.bake_s += seconds() - indexed_at;  // the placement is known, the grid is made again
    totals.probes += probes.size();
    totals.candidates += (*placed)->report.candidates;
    totals.moved += (*placed)->report.moved_out;
    totals.dropped += (*placed)->report.dropped_in_solid;
    totals.buried_cells += grid.buried_cells;
    totals.blind_cells += grid.blind_cells;
    for (const std::string& warning : baked->warnings)
        std::printf("  %s\n", warning.c_str());
}

}  // namespace
}  // namespace drtv::bench

int main(int argc, char** argv) {
    using namespace drtv;
    if (argc < 2) {
        std::fprintf(stderr, "usage: placement_bench MAP.glb [SECTORS]\n");
        return 1;
    }
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const trace::FloatMode float_mode;
    const auto world = bench::open_world(argv[1]);
    if (!world)
        return 2;
    const auto& sectors = world->sectors();
    const std::size_t wanted = argc > 2 ? static_cast<std::size_t>(std::atoi(argv[2])) : sectors.size();
    const std::size_t step = std::max<std::size_t>(1, sectors.size() / std::max<std::size_t>(1, wanted));
    bench::Totals totals;
    std::size_t count = 0;
    for (std::size_t n = 0; n < sectors.size(); n += step, ++count)
        bench::add_sector(*world, sectors[n], settings::BakeSettings{}, totals);
    const double all_s = totals.place_s + totals.bake_s;
    std::printf(
        "%zu sectors, %zu probes of %zu candidates, %zu moved, %zu dropped; of %zu cells %zu in solids, "
        "%zu see none\n",
        count, totals.probes, totals.candidates, totals.moved, totals.dropped, count * 4096,
        totals.buried_cells, totals.blind_cells);
    std::printf("a sector: place %.1f ms, grid %.1f ms, bake %.1f ms; placement and grid %.1f %%\n",
                1e3 * totals.place_s / static_cast<double>(count),
                1e3 * totals.grid_s / static_cast<double>(count), 1e3 * all_s / static_cast<double>(count),
                100 * (totals.place_s + totals.grid_s) / all_s);
}
