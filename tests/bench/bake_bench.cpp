// Speed of the bake beside Embree alone on the same rays, in one run:
//   bake_bench MAP.glb [--benchmark_...]
// Integration is single-threaded; `over_embree` is the time of the bake over that of Embree, measured in
// pairs.
#include "bakerd/bake/integrate.h"
#include "bakerd/bake/sector_bake.h"
#include "bakerd/bake/sector_file.h"
#include "bakerd/reuse/footprint_recorder.h"
#include "tests/bake/ray_log.h"
#include "tests/bench/bench_world.h"
#include "tests/bench/raw_embree.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

namespace drtv::bench {
namespace {

constexpr std::size_t max_probes = 48;

struct Setup {
    std::shared_ptr<bake::World> world;
    std::vector<map::SectorCoordinate> sectors;
    std::shared_ptr<const trace::Scene> scene;
    std::vector<glm::ivec3> probes;
    std::unique_ptr<bake::SampleTable> samples;
    test::RayLog rays;
    [[nodiscard]] std::size_t ray_count() const { return rays.paths.size() + rays.shadows.size(); }
    std::unique_ptr<RawEmbree> embree;
    map::SectorCoordinate sector;  // of the probes
    settings::BakeSettings settings;
};

std::optional<Setup> setup;

std::uint64_t integrate_all(bake::RayWatch* watch = nullptr) {
    const trace::FloatMode float_mode;
    std::uint64_t rays = 0;
    for (const glm::ivec3& probe : setup->probes) {
        const bake::ProbeLight light =
            bake::integrate_probe(*setup->scene, setup->world->lights(), probe, *setup->samples,
                                  {setup->settings.bounces, setup->settings.reach_m, 0}, watch);
        rays += light.rays + light.shadow_rays;
    }
    return rays;
}

bool prepare(const std::string& path) {
    auto world = open_world(path);
    if (!world)
        return false;
    setup.emplace();
    setup->world = std::move(world);
    setup->sectors = setup->world->sectors();
    const map::SectorCoordinate middle = setup->sector = setup->sectors[setup->sectors.size() / 2];
    settings::BakeSettings few = setup->settings;
    few.rays = 16;
    const Sector sector = bake::bake_sector(*setup->world, middle, few).value().sector;
    for (std::size_t p = 0; p < sector.probes.size() && p < max_probes; ++p) {
        const auto units = position_units(sector, sector.probes[p]);
        setup->probes.emplace_back(units[0], units[1], units[2]);
    }
    setup->scene = setup->world->scene_for(middle, setup->settings.reach_m);
    setup->samples = std::make_unique<bake::SampleTable>(
        setup->settings.rays,
        bake::sample_dimensions(setup->settings.bounces, !setup->world->lights().empty()));
    static_cast<void>(integrate_all(&setup->rays));
    setup->embree = std::make_unique<RawEmbree>(setup->world->map());
    return true;
}

void integrate_probes(benchmark::State& state) {
    std::uint64_t rays = 0;
    for (auto _ : state)
        rays += integrate_all();
    state.counters["rays/s"] = benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsRate);
    state.counters["probes/s"] = benchmark::Counter(
        static_cast<double>(setup->probes.size()) * static_cast<double>(state.iterations()),
        benchmark::Counter::kIsRate);
}
BENCHMARK(integrate_probes)->Unit(benchmark::kMillisecond);

void embree_alone(benchmark::State& state) {
    const trace::FloatMode float_mode;
    for (auto _ : state)
        benchmark::DoNotOptimize(setup->embree->trace(setup->rays.paths, setup->rays.shadows));
    state.counters["rays/s"] =
        benchmark::Counter(static_cast<double>(setup->ray_count()) * static_cast<double>(state.iterations()),
                           benchmark::Counter::kIsRate);
}
BENCHMARK(embree_alone)->Unit(benchmark::kMillisecond);

// Bake and Embree in turn, so that the machine's moods meet both.
void bake_over_embree(benchmark::State& state) {
    const trace::FloatMode float_mode;
    std::vector<double> ratios;
    for (auto _ : state) {
        const double start = seconds();
        benchmark::DoNotOptimize(integrate_all());
        const double between = seconds();
        benchmark::DoNotOptimize(setup->embree->trace(setup->rays.paths, setup->rays.shadows));
        ratios.push_back((between - start) / (seconds() - between));
    }
    std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2),
                     ratios.end());
    state.counters["over_embree"] = ratios[ratios.size() / 2];
}
BENCHMARK(bake_over_embree)->Unit(benchmark::kMillisecond)->Iterations(15);

// The price of noting what the rays cross, measured in pairs.
void footprint_over_none(benchmark::State& state) {
    const trace::FloatMode float_mode;
    std::vector<double> ratios;
    const reuse::FootprintGrid grid = reuse::footprint_grid(
        setup->sector, setup->settings.reach_m, setup->scene->bounds().low.z, setup->scene->bounds().high.z);
    for (auto _ : state) {
        const double start = seconds();
        benchmark::DoNotOptimize(integrate_all());
        const double between = seconds();
        reuse::FootprintRecorders recorders(setup->sector, grid);
        benchmark::DoNotOptimize(integrate_all(&recorders.of_this_thread()));
        reuse::Footprint footprint;
        recorders.store(footprint);
        ratios.push_back((seconds() - between) / (between - start));
    }
    std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2),
                     ratios.end());
    state.counters["over_none"] = ratios[ratios.size() / 2];
}
BENCHMARK(footprint_over_none)->Unit(benchmark::kMillisecond)->Iterations(15);

// A whole sector: placement, integration, grid, encoding.
void whole_sector(benchmark::State& state) {
    const map::SectorCoordinate middle = setup->sectors[setup->sectors.size() / 2];
    std::size_t probes = 0;
    for (auto _ : state) {
        const Sector sector = bake::bake_sector(*setup->world, middle, setup->settings).value().sector;
        std::vector<std::string> warnings;
        benchmark::DoNotOptimize(bake::encode_sector(sector, warnings).value());
        probes += sector.probes.size();
    }
    state.counters["probes/s"] = benchmark::Counter(static_cast<double>(probes), benchmark::Counter::kIsRate);
}
BENCHMARK(whole_sector)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace drtv::bench

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (argc != 2) {
        std::fprintf(stderr, "usage: bake_bench MAP.glb [--benchmark_...]\n");
        return 1;
    }
    if (!drtv::bench::prepare(argv[1]))
        return 1;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
