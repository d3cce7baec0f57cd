#include "bakerd/bake/sector_bake.h"

#include "bakerd/bake/convergence.h"
#include "bakerd/bake/integrate.h"
#include "bakerd/bake/local_encoding.h"
#include "bakerd/bake/placed_sector.h"
#include "bakerd/bake/static_gain.h"
#include "placement/grid.h"

#include <drtv/read.h>
#include <drtv/validate.h>
#include <drtv/write.h>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

namespace drtv::bake {
namespace {

static_assert(placement::grid_size == grid_size && placement::no_probe == no_probe);

// Above this share of rays that end at the back of a one-sided surface, something stands inside out or open.
constexpr double most_back_hits = 0.05;

constexpr int least_static_exponent = -64;

// What a file holds of a probe, and its share of the statistics.
struct BakedProbe {
    TransferCodes transfer{};
    VisibilityCodes sky_visibility{};
    StaticIrradiance static_irradiance{{}, least_static_exponent};
    ProbeRecord record;
    std::uint32_t paths = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>>
        back_hit_objects;  // as ProbeLight has them; nothing where it was taken over
};

BakedProbe encoded(const placement::Position& position, const ProbeLight& light) {
    BakedProbe baked;
    float brightest = 0;
    for (const auto& channel : light.static_irradiance)
        brightest = std::max(brightest, *std::ranges::max_element(channel));
    StaticIrradiance& lit = baked.static_irradiance;
    lit.exponent = static_cast<std::int8_t>(exponent_of(brightest, least_static_exponent));
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b) {
            for (std::size_t i = 0; i < sh_count; ++i)
                baked.transfer[c][b][i] = encode_fixed(light.transfer[c][b][i], transfer_scale);
            lit.codes[c][b] = encode_fixed(light.static_irradiance[c][b], scale_of_exponent(lit.exponent));
        }
    }
    for (std::size_t b = 0; b < basis_count; ++b)
        baked.sky_visibility[b] = encode_fixed(light.sky_visibility[b], sky_visibility_scale);
    baked.record = {position,
                    static_cast<std::uint32_t>(light.rays),
                    static_cast<std::uint32_t>(light.shadow_rays),
                    static_cast<std::uint32_t>(light.back_hits),
                    light.error,
                    0};
    baked.paths = light.paths;
    baked.back_hit_objects = light.back_hit_objects;
    return baked;
}

void store_lights(const std::vector<BakedProbe>& lights, Sector& sector) {
    for (std::size_t p = 0; p < lights.size(); ++p) {
        sector.probes[p].transfer = lights[p].transfer;
        sector.probes[p].sky_visibility = lights[p].sky_visibility;
        sector.statistics.rays += lights[p].record.rays;
        sector.statistics.back_hits += lights[p].record.back_hits;
    }
    // Nothing where no probe gets any static light.
    if (std::ranges::all_of(
            lights, [](const BakedProbe& light) { return light.static_irradiance.codes == LightCodes{}; }))
        return;
    for (const BakedProbe& light : lights)
        sector.static_irradiance.push_back(light.static_irradiance);
}

// An earlier bake's probe of each of these, where it can be taken over.
std::vector<std::optional<BakedProbe>> taken_over(const EarlierBake* earlier,
                                                  std::span<const placement::Position> positions,
                                                  const Settings& settings) {
    std::vector<std::optional<BakedProbe>> probes(positions.size());
    if (earlier == nullptr)
        return probes;
    const auto order = [](const placement::Position& position) {
        return std::tuple(position.x, position.y, position.z);
    };
    std::map<std::tuple<std::int32_t, std::int32_t, std::int32_t>, std::size_t> earlier_probes;
    for (std::size_t q = 0; q < earlier->footprint.probes.size(); ++q) {
        if (earlier->assessment.probe_bounds[q] <= settings.tolerance)
            earlier_probes[order(earlier->footprint.probes[q].position)] = q;
    }
    for (std::size_t p = 0; p < positions.size(); ++p) {
        const auto found = earlier_probes.find(order(positions[p]));
        if (found == earlier_probes.end())
            continue;
        const std::size_t q = found->second;
        BakedProbe& probe = probes[p].emplace();
        probe.transfer = earlier->sector.probes[q].transfer;
        probe.sky_visibility = earlier->sector.probes[q].sky_visibility;
        if (!earlier->sector.static_irradiance.empty())
            probe.static_irradiance = earlier->sector.static_irradiance[q];
        probe.record = earlier->footprint.probes[q];
        probe.record.share = earlier->assessment.probe_bounds[q] / earlier->assessment.gain;
        probe.paths = settings.rays;
    }
    return probes;
}

// Whether the record belongs to the file, and probes can be taken over one by one.
bool is_of_use(const EarlierBake& earlier, const FootprintGrid& grid) {
    const Sector& sector = earlier.sector;
    const std::size_t count = sector.probes.size();
    // Of many surfaces seen from behind the artist is told with their names, which are not kept.
    const bool many_backs = static_cast<double>(sector.statistics.back_hits) >
                            most_back_hits * static_cast<double>(sector.statistics.rays);
    return !earlier.footprint.without_bounds && earlier.footprint.grid == grid &&
           earlier.footprint.probes.size() == count && earlier.assessment.probe_bounds.size() == count &&
           !many_backs;
}

// Where the earlier bake's probes stand, as placement would give it.
PlacedSector placement_of(const EarlierBake& earlier) {
    const Sector& file = earlier.sector;
    PlacedSector placed;
    placed.sector.i = file.i;
    placed.sector.j = file.j;
    placed.sector.z_origin_units = file.z_origin_units;
    placed.sector.z_shift = file.z_shift;
    for (const Probe& probe : file.probes)
        placed.sector.probes.push_back({probe.position, probe.kind, {}, {}});
    for (const ProbeRecord& probe : earlier.footprint.probes)
        placed.positions.push_back(probe.position);
    const Statistics& s = file.statistics;
    placed.report = {
        s.candidates, s.moved_out, s.dropped_in_solid, s.removed_by_volume, s.thinned, s.used_distance_m};
    // Rays that may end otherwise cannot be counted on any more.
    placed.solid_tests = earlier.footprint.solid_tests;
    for (std::size_t n = 0; n < placed.solid_tests.size(); ++n)
        placed.solid_tests[n].to_flip =
            static_cast<std::uint8_t>(placed.solid_tests[n].to_flip - earlier.assessment.flips[n]);
    return placed;
}

void store_report(const placement::Report& report, Statistics& statistics) {
    statistics.candidates = report.candidates;
    statistics.moved_out = report.moved_out;
    statistics.dropped_in_solid = report.dropped_in_solid;
    statistics.removed_by_volume = report.removed_by_volume;
    statistics.thinned = report.thinned;
    statistics.used_distance_m = report.used_distance_m;
}

Convergence convergence_of(const std::vector<BakedProbe>& lights, const Settings& settings) {
    Convergence convergence;
    convergence.error_asked = settings.error;
    std::vector<float> errors;
    for (const BakedProbe& light : lights) {
        errors.push_back(light.record.error);
        convergence.paths_least =
            errors.size() == 1 ? light.paths : std::min(convergence.paths_least, light.paths);
        convergence.paths_most = std::max(convergence.paths_most, light.paths);
        convergence.static_rays += light.record.shadow_rays;
    }
    const ErrorSummary summary = summarise(std::move(errors));
    convergence.error_median = summary.median;
    convergence.error_p95 = summary.p95;
    convergence.error_max = summary.max;
    return convergence;
}

// Warns of surfaces seen from behind, and names the object that most of them belong to.
void warn_of_backs(const map::Map& map,
                   const Sector& sector,
                   const std::vector<BakedProbe>& lights,
                   std::vector<std::string>& warnings) {
    const double share = static_cast<double>(sector.statistics.back_hits) /
                         static_cast<double>(std::max<std::uint64_t>(sector.statistics.rays, 1));
    if (!(share > most_back_hits))
        return;
    std::map<std::uint32_t, std::uint64_t> by_object;
    for (const BakedProbe& light : lights) {
        for (const auto& [object, hits] : light.back_hit_objects)
            by_object[object] += hits;
    }
    if (by_object.empty())
        return;  // of probes that were taken over the objects are not known
    const auto most = std::ranges::max_element(by_object, {}, [](const auto& entry) { return entry.second; });
    const std::string& name = map.objects[most->first].name;
    warnings.push_back(
        fmt::format("sector ({}, {}): {:.0f} % of its rays meet surfaces from behind, most of them those of "
                    "'{}': are its faces turned, or is a side of it missing?",
                    sector.i,
                    sector.j,
                    share * 100,
                    name.empty() ? "an object without a name" : name));
}

// Those whose probe stands in the sector. Fails with a sentence when they are too many for one file.
tl::expected<void, std::string> store_interiors(const World& world,
                                                const PlacedSector& placed,
                                                Sector& sector) {
    std::size_t vertices = 0, triangles = 0;
    for (const InteriorVolume& interior : world.interiors()) {
        if (interior.sector != map::SectorCoordinate{sector.i, sector.j} || !interior.probe)
            continue;
        // Manual probes are never given up, but heights are rounded.
        const auto squared = [&](const placement::Position& position) {
            const glm::dvec3 offset(position - *interior.probe);
            return glm::dot(offset, offset);
        };
        const auto probe = std::ranges::min_element(placed.positions, {}, squared) - placed.positions.begin();
        sector.interiors.push_back(interior.stored);
        sector.interiors.back().probe = static_cast<std::uint8_t>(probe);
        vertices += interior.stored.vertices.size();
        triangles += interior.stored.triangles.size();
    }
    if (sector.interiors.size() <= max_interiors && vertices <= max_interiors_vertices &&
        triangles <= max_interior_triangles)
        return {};
    return tl::unexpected(
        fmt::format("sector ({}, {}) has {} interiors with {} vertices and {} triangles, over the limits of "
                    "{}, {} and {}",
                    sector.i,
                    sector.j,
                    sector.interiors.size(),
                    vertices,
                    triangles,
                    max_interiors,
                    max_interiors_vertices,
                    max_interior_triangles));
}

// By place; one of each. Neighbours test the same points.
void sort_tests(std::vector<SolidTest>& tests) {
    std::ranges::sort(tests, {}, [](const SolidTest& test) {
        return std::tuple(test.position.y, test.position.x, test.position.z, test.to_flip);
    });
    const auto again = std::ranges::unique(tests);
    tests.erase(again.begin(), again.end());
}

// Local transfer from the sector's probes and its neighbours'.
void bake_local(World& world,
                const trace::Scene& scene,
                const PlacedSector& placed,
                const Settings& settings,
                FootprintRecorders& recorders,
                BakedSector& baked) {
    Sector& sector = baked.sector;
    std::vector<std::shared_ptr<const Placed>> around;
    std::vector<const PlacedSector*> neighbours;
    for (std::int32_t dj = -1; dj <= 1; ++dj) {
        for (std::int32_t di = -1; di <= 1; ++di) {
            const map::SectorCoordinate coordinate{placed.sector.i + di, placed.sector.j + dj};
            if ((di == 0 && dj == 0) || !world.has_ground(coordinate))
                continue;
            around.push_back(world.placed(coordinate, settings, scene));
            if (!*around.back())
                continue;  // what cannot be placed has no probes
            const PlacedSector& neighbour = **around.back();
            neighbours.push_back(&neighbour);
            baked.footprint.solid_tests.insert(baked.footprint.solid_tests.end(),
                                               neighbour.solid_tests.begin(),
                                               neighbour.solid_tests.end());
        }
    }
    const LocalSources sources = local_sources(placed, neighbours, settings.reach_m);
    const LocalLight light =
        integrate_local(scene,
                        sources.positions,
                        placed.positions.size(),
                        *world.samples(settings.local_rays, local_sample_dimensions(settings.local_bounces)),
                        {settings.local_bounces, settings.reach_m},
                        &recorders);
    sector.local_transfer = encode_local(sources, light, placed.positions.size(), settings.reach_m);
    sector.convergence->local_bounces = settings.local_bounces;
    sector.convergence->local_rays = settings.local_rays;
    sector.convergence->local_transfer_rays = light.rays;
}

}  // namespace

tl::expected<BakedSector, std::string> bake_sector(World& world,
                                                   map::SectorCoordinate coordinate,
                                                   const Settings& settings,
                                                   const EarlierBake* earlier) {
    const trace::FloatMode float_mode;
    const auto scene = world.scene_for(coordinate, scene_distance_m(settings));
    const auto samples =
        world.samples(settings.rays, sample_dimensions(settings.bounces, !world.lights().empty()));
    const FootprintGrid footprint_cells =
        footprint_grid(coordinate, scene_distance_m(settings), scene->bounds().low.z, scene->bounds().high.z);
    if (earlier != nullptr && !is_of_use(*earlier, footprint_cells))
        earlier = nullptr;
    const bool placement_holds = earlier != nullptr && earlier->assessment.placement_holds;
    const auto placed = placement_holds ? std::make_shared<const Placed>(placement_of(*earlier))
                                        : world.placed(coordinate, settings, *scene);
    if (!*placed)
        return tl::unexpected(placed->error());
    const std::vector<placement::Position>& positions = (*placed)->positions;

    BakedSector baked;
    Sector& sector = baked.sector;
    sector = (*placed)->sector;
    FootprintRecorders recorders(footprint_cells);
    const std::vector<std::optional<BakedProbe>> kept = taken_over(earlier, positions, settings);
    std::vector<BakedProbe> lights(positions.size());
    const auto integrate_all = [&] {
        tbb::parallel_for(std::size_t{0}, positions.size(), [&](std::size_t p) {
            if (kept[p]) {
                lights[p] = *kept[p];
                return;
            }
            const trace::FloatMode task_float_mode;
            FootprintRecorder& recorder = recorders.of_this_thread();
            recorder.begin(quarter_of(coordinate, positions[p]));
            lights[p] = encoded(positions[p],
                                integrate_probe(*scene,
                                                world.lights(),
                                                positions[p],
                                                *samples,
                                                {settings.bounces, settings.reach_m, settings.error},
                                                {&recorder, nullptr}));
        });
    };
    const auto index_all = [&] {
        if (placement_holds) {
            sector.grid = earlier->sector.grid;
            return;
        }
        const trace::FloatMode task_float_mode;
        const placement::ProbeGrid grid = placement::build_grid(
            coordinate.i, coordinate.j, positions, surroundings_of(*scene, settings.reach_m));
        sector.grid = {grid.z_origin_units, grid.cell_height_units, grid.cells};
    };
    // Isolated: a thread that waits for the rest of its sector must not start another one in between.
    tbb::this_task_arena::isolate([&] { tbb::parallel_invoke(integrate_all, index_all); });

    store_report((*placed)->report, sector.statistics);
    store_lights(lights, sector);
    sector.bake = {settings.rays,
                   settings.bounces,
                   settings.reach_m,
                   settings.min_distance_m,
                   settings_key(settings).bytes};
    sector.convergence = convergence_of(lights, settings);
    warn_of_backs(world.map(), sector, lights, baked.warnings);
    if (auto stored = store_interiors(world, **placed, sector); !stored)
        return tl::unexpected(stored.error());
    Footprint& footprint = baked.footprint;
    footprint.solid_tests = (*placed)->solid_tests;
    if (settings.local_transfer)
        tbb::this_task_arena::isolate(
            [&] { bake_local(world, *scene, **placed, settings, recorders, baked); });
    footprint.sector = coordinate;
    footprint.reach_m = settings.reach_m;
    footprint.rays = settings.rays;
    footprint.without_bounds = settings.local_transfer || settings.error > 0;
    const bool near =
        std::ranges::any_of(lights, [](const BakedProbe& light) { return light.record.share > 0; });
    footprint.most_scattered =
        near ? std::max(world.most_scattered(), earlier->footprint.most_scattered) : world.most_scattered();
    footprint.static_gain =
        static_gain(world.lights(), footprint.most_scattered, *scene, positions, settings);
    if (near)
        footprint.static_gain = std::max(footprint.static_gain, earlier->assessment.static_gain);
    footprint.placement_m = placement_margin_m(settings);
    footprint.min_distance_m = settings.min_distance_m;
    for (const BakedProbe& light : lights)
        footprint.probes.push_back(light.record);
    // What was taken over still depends on where its own rays went; the rest's older ones are among these,
    // and cost sharpness alone.
    baked.probes_taken_over = static_cast<std::size_t>(
        std::ranges::count_if(kept, [](const auto& probe) { return probe.has_value(); }));
    if (baked.probes_taken_over == 0) {
        recorders.store(footprint);
    } else {
        footprint.grid = earlier->footprint.grid;
        footprint.crossed = earlier->footprint.crossed;
        footprint.weights = earlier->footprint.weights;
        recorders.merge_into(footprint);
    }
    sort_tests(footprint.solid_tests);
    return baked;
}

tl::expected<std::vector<std::uint8_t>, std::string> encode_sector(const Sector& sector,
                                                                   std::vector<std::string>& warnings) {
    std::vector<std::uint8_t> bytes = write_sector(sector);
    const Report report = validate_sector(bytes);
    const auto sentence = [&](const Finding& finding) {
        return fmt::format("{} {} {}", finding.issue->code, finding.path, finding.message);
    };
    if (!report.valid()) {
        const auto error = std::ranges::find_if(report.findings, [](const Finding& finding) {
            return finding.issue->severity == Severity::error;
        });
        return tl::unexpected(fmt::format(
            "sector ({}, {}) does not pass validation: {}",
            sector.i,
            sector.j,
            error == report.findings.end() ? "too many findings to show an error" : sentence(*error)));
    }
    for (const Finding& finding : report.findings)
        warnings.push_back(fmt::format("sector ({}, {}): {}", sector.i, sector.j, sentence(finding)));
    return bytes;
}

std::optional<Sector> decode_sector(std::span<const std::uint8_t> bytes) {
    Sector sector;
    if (!read_sector(bytes, sector).ok())
        return std::nullopt;
    return sector;
}

}  // namespace drtv::bake
