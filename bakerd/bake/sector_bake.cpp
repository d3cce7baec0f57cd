#include "bakerd/bake/sector_bake.h"

#include "bakerd/bake/artist_warnings.h"
#include "bakerd/bake/integrate.h"
#include "bakerd/bake/interiors.h"
#include "bakerd/bake/local_encoding.h"
#include "bakerd/bake/local_transfer.h"
#include "bakerd/bake/placement_scene.h"
#include "bakerd/bake/probe_warnings.h"
#include "bakerd/bake/settings_key.h"
#include "placement/grid.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace drtv::bake {
namespace {

void store_report(const placement::PlacementReport& report, Statistics& statistics) {
    statistics.candidates = report.candidates;
    statistics.moved_out = report.moved_out;
    statistics.dropped_in_solid = report.dropped_in_solid;
    statistics.removed_by_volume = report.removed_by_volume;
    statistics.thinned = report.thinned;
    statistics.used_distance_m = report.used_distance_m;
}

// By place; one of each. Neighbours test the same points.
void sort_tests(std::vector<placement::SolidTest>& tests) {
    std::ranges::sort(tests, {}, [](const placement::SolidTest& test) {
        return std::tuple(test.position.y, test.position.x, test.position.z, test.to_flip);
    });
    const auto again = std::ranges::unique(tests);
    tests.erase(again.begin(), again.end());
}

class SectorBake {
  public:
    SectorBake(World& world,
               map::SectorCoordinate coordinate,
               const settings::BakeSettings& settings,
               const Given& given,
               const WatchOfThread& watch)
        : world_(world),
          coordinate_(coordinate),
          settings_(settings),
          given_(given),
          watch_(watch),
          around_(world.surroundings(coordinate, settings)) {
        baked_.seconds.scene = stopwatch_.lap();
    }

    tl::expected<BakedSector, std::string> run() {
        stopwatch_.lap();
        const auto placed = given_.placement ? std::make_shared<const Placed>(*given_.placement)
                                             : world_.placed(coordinate_, settings_, *around_.scene);
        if (!*placed)
            return tl::unexpected(placed->error());
        begin(**placed);
        baked_.seconds.placement = stopwatch_.lap();
        // Isolated: a thread that waits for the rest of its sector must not start another one in between.
        tbb::this_task_arena::isolate(
            [&] { tbb::parallel_invoke([&] { integrate_probes(); }, [&] { index_probes(); }); });
        baked_.seconds.transfer = stopwatch_.lap();
        if (auto stored = store_probes(probes_, baked_.sector); !stored)
            return tl::unexpected(stored.error());
        complete_quality(**placed);
        for (const BakedProbe& probe : probes_)
            baked_.counts.push_back(probe.counts);
        baked_.sector.convergence = convergence_of(probes_, settings_);
        warn_of_all();
        if (auto stored = store_interiors(world_.interiors(), baked_.positions, baked_.sector); !stored)
            return tl::unexpected(stored.error());
        stopwatch_.lap();
        if (settings_.local_transfer)
            tbb::this_task_arena::isolate([&] { bake_local(**placed); });
        baked_.seconds.local_transfer = stopwatch_.lap();
        sort_tests(baked_.solid_tests);
        return std::move(baked_);
    }

  private:
    void begin(const PlacedSector& placed) {
        baked_.sector = placed.sector;
        baked_.positions = placed.positions;
        baked_.solid_tests = placed.solid_tests;
        baked_.placement_warnings = baked_.warnings = placed.warnings;
        store_report(placed.report, baked_.sector.statistics);
        baked_.sector.bake = {settings_.rays,
                              settings_.bounces,
                              settings_.reach_m,
                              settings_.min_distance_m,
                              settings_key(settings_).bytes};
        probes_.resize(placed.positions.size());
        back_hits_.resize(placed.positions.size());
    }

    void integrate_probes() {
        const IntegrationSettings how{settings_.bounces, settings_.reach_m, settings_.error};
        tbb::parallel_for(std::size_t{0}, probes_.size(), [&](std::size_t p) {
            const placement::Position& position = baked_.positions[p];
            if (const auto known = given_.probes.find(position); known != given_.probes.end()) {
                probes_[p] = known->second;
                return;
            }
            const trace::FloatMode float_mode;
            RayWatch* watch = watch_ ? &watch_() : nullptr;
            ProbeLight light =
                integrate_probe(*around_.scene, world_.lights(), position, *around_.samples, how, watch);
            probes_[p] = encode_probe(light, world_.lights().sets());
            back_hits_[p] = std::move(light.back_hit_objects);
        });
    }

    void index_probes() {
        if (given_.grid) {
            indexed_ = *given_.grid;
            baked_.sector.grid = indexed_.grid;
            return;
        }
        const trace::FloatMode float_mode;
        const placement::ProbeGrid grid = placement::build_grid(
            coordinate_.i, coordinate_.j, grid_probes(), queries_of(*around_.scene, settings_.reach_m));
        indexed_ = {
            {grid.z_origin_units, grid.cell_height_units, grid.cells}, grid.buried_cells, grid.blind_cells};
        baked_.sector.grid = indexed_.grid;
    }

    // What the probes' own light does not say.
    void complete_quality(const PlacedSector& placed) {
        if (!baked_.sector.quality)
            return;
        Quality& quality = *baked_.sector.quality;
        quality.buried_cells = indexed_.buried_cells;
        quality.blind_cells = indexed_.blind_cells;
        for (std::size_t p = 0; p < quality.probes.size(); ++p) {
            quality.probes[p].dark = is_dark(baked_.sector, p);
            quality.probes[p].moved = placed.moved[p];
        }
    }

    // With the interiors that name them.
    [[nodiscard]] std::vector<placement::GridProbe> grid_probes() const {
        std::vector<placement::GridProbe> probes;
        for (const placement::Position& position : baked_.positions)
            probes.push_back({position, {}});
        for (const InteriorVolume& interior : world_.interiors()) {
            if (interior.probe && interior.sector == coordinate_)
                probes[probe_at(*interior.probe, baked_.positions)].interiors.push_back(&interior.volume);
        }
        return probes;
    }

    void warn_of_all() {
        warn_of_back_hits(world_.map(), baked_.sector, back_hits_, baked_.warnings);
        const trace::FloatMode float_mode;
        const std::size_t before = baked_.warnings.size();
        warn_of_closed_sky(*around_.scene, baked_.sector, baked_.positions, baked_.warnings);
        if (baked_.warnings.size() == before)  // else that is why they are dark
            warn_of_dark_probes(*around_.scene, baked_.sector, baked_.positions, baked_.warnings);
        warn_of_enclosed_lamps(*around_.scene, coordinate_, baked_.warnings);
    }

    // Local transfer from the sector's probes and its neighbours'.
    void bake_local(const PlacedSector& placed) {
        std::vector<std::shared_ptr<const Placed>> around;
        std::vector<const PlacedSector*> placed_around;
        for (const map::SectorCoordinate& coordinate : neighbours()) {
            around.push_back(world_.placed(coordinate, settings_, *around_.scene));
            if (!*around.back())
                continue;  // what cannot be placed has no probes
            const PlacedSector& neighbour = **around.back();
            placed_around.push_back(&neighbour);
            baked_.solid_tests.insert(
                baked_.solid_tests.end(), neighbour.solid_tests.begin(), neighbour.solid_tests.end());
        }
        const LocalSources sources = local_sources(placed, placed_around, settings_.reach_m);
        const auto samples =
            world_.samples(settings_.local_rays, local_sample_dimensions(settings_.local_bounces));
        const LocalSettings how{settings_.local_bounces, settings_.reach_m};
        const LocalLight light =
            integrate_local(*around_.scene, sources.positions, sources.of_receivers, *samples, how, watch_);
        Sector& sector = baked_.sector;
        sector.local_transfer = encode_local(sources, light);
        sector.convergence->local_bounces = settings_.local_bounces;
        sector.convergence->local_rays = settings_.local_rays;
        sector.convergence->local_transfer_rays = light.rays;
    }

    [[nodiscard]] std::vector<map::SectorCoordinate> neighbours() const {
        std::vector<map::SectorCoordinate> found;
        for (std::int32_t dj = -1; dj <= 1; ++dj) {
            for (std::int32_t di = -1; di <= 1; ++di) {
                const map::SectorCoordinate coordinate{coordinate_.i + di, coordinate_.j + dj};
                if (coordinate != coordinate_ && world_.has_sector(coordinate))
                    found.push_back(coordinate);
            }
        }
        return found;
    }

    World& world_;
    const map::SectorCoordinate coordinate_;
    const settings::BakeSettings& settings_;
    const Given& given_;
    const WatchOfThread& watch_;
    Stopwatch stopwatch_;
    const Surroundings around_;

    BakedSector baked_;
    std::vector<BakedProbe> probes_;
    Given::IndexedGrid indexed_;
    std::vector<BackHits> back_hits_;  // of each probe that was not given
};

}  // namespace

tl::expected<BakedSector, std::string> bake_sector(World& world,
                                                   map::SectorCoordinate coordinate,
                                                   const settings::BakeSettings& settings,
                                                   const Given& given,
                                                   const WatchOfThread& watch) {
    const trace::FloatMode float_mode;
    return SectorBake(world, coordinate, settings, given, watch).run();
}

}  // namespace drtv::bake
