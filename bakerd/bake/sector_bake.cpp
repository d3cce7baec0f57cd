#include "bakerd/bake/sector_bake.h"

#include "bakerd/bake/integrate.h"
#include "placement/grid.h"
#include "placement/placement.h"

#include <drtv/validate.h>
#include <drtv/write.h>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace drtv::bake {
namespace {

static_assert(placement::units_per_m == position_units_per_m && placement::sector_size_m == sector_size_m);
static_assert(placement::grid_size == grid_size && placement::no_probe == no_probe && placement::max_probes == max_probes);

placement::Surroundings surroundings_of(const trace::Scene& scene, float reach_m) {
    placement::Surroundings surroundings;
    surroundings.column = [&scene](glm::vec2 at, std::vector<placement::ColumnHit>& hits) {
        std::vector<trace::ColumnHit> found;
        scene.column(at, found);
        hits.clear();
        for (const trace::ColumnHit& hit : found) hits.push_back({hit.z_m, hit.up_facing, hit.down_facing});
    };
    surroundings.meets_back = [&scene, reach_m](const glm::vec3& origin, const glm::vec3& direction) {
        const auto hit = scene.closest({origin, direction, reach_m});
        return hit && !hit->front && scene.surface(*hit).absorbs;
    };
    surroundings.sees = [&scene](const glm::vec3& from, const glm::vec3& to) {
        const float distance_m = glm::length(to - from);
        return distance_m <= 0 || !scene.occluded({from, (to - from) / distance_m, distance_m});
    };
    return surroundings;
}

tl::expected<placement::Placement, std::string> place(const World& world, const trace::Scene& scene, const placement::Surroundings& surroundings, map::SectorCoordinate sector, float min_distance_m) {
    const placement::Settings settings{min_distance_m};
    const glm::vec2 corner = glm::vec2(sector.i, sector.j) * static_cast<float>(map::sector_size_m);
    const float margin_m = placement::decision_margin_m(settings);
    std::vector<placement::Box> vegetation;
    for (const map::Bounds& bounds : scene.vegetation_bounds({corner - margin_m, corner + static_cast<float>(map::sector_size_m) + margin_m})) vegetation.push_back({bounds.low, bounds.high});
    return placement::place_probes({sector.i, sector.j, vegetation, world.manual_probes(), world.no_probes()}, surroundings, settings);
}

ProbeKind kind_of(placement::Kind kind) {
    switch (kind) {
        case placement::Kind::ground: return ProbeKind::ground;
        case placement::Kind::vegetation: return ProbeKind::vegetation;
        case placement::Kind::manual: return ProbeKind::manual;
    }
    return ProbeKind::ground;
}

// Heights in 16 bits against the lowest probe: steps of 2^-10 m where the sector's probes span up to 64 m, doubled as
// often as needed where they span more.
tl::expected<void, std::string> store_positions(const std::vector<placement::PlacedProbe>& probes, Sector& sector) {
    if (probes.empty()) return {};
    const auto by_height = [](const placement::PlacedProbe& a, const placement::PlacedProbe& b) { return a.position.z < b.position.z; };
    const std::int32_t lowest = std::min_element(probes.begin(), probes.end(), by_height)->position.z;
    const std::int32_t highest = std::max_element(probes.begin(), probes.end(), by_height)->position.z;
    sector.z_origin_units = lowest;
    const auto step_of = [&](std::int32_t z) { return (z - lowest + ((1 << sector.z_shift) >> 1)) >> sector.z_shift; };
    while (step_of(highest) > 65535) {
        if (++sector.z_shift > max_z_shift) return tl::unexpected(fmt::format("sector ({}, {}): its probes span {} m of height", sector.i, sector.j, (highest - lowest) / position_units_per_m));
    }
    constexpr std::int32_t side = sector_size_m * position_units_per_m;
    for (const placement::PlacedProbe& placed : probes) {
        Probe probe;
        probe.position = {static_cast<std::uint16_t>(placed.position.x - sector.i * side), static_cast<std::uint16_t>(placed.position.y - sector.j * side),
                          static_cast<std::uint16_t>(step_of(placed.position.z))};
        probe.kind = kind_of(placed.kind);
        sector.probes.push_back(probe);
    }
    return {};
}

void store_light(const ProbeLight& light, Probe& probe) {
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b) {
            for (std::size_t i = 0; i < sh_count; ++i) probe.transfer[c][b][i] = encode_fixed(light.transfer[c][b][i], transfer_scale);
        }
    }
    for (std::size_t b = 0; b < basis_count; ++b) probe.sky_visibility[b] = encode_fixed(light.sky_visibility[b], sky_visibility_scale);
}

void store_report(const placement::Report& report, Statistics& statistics) {
    statistics.candidates = report.candidates;
    statistics.moved_out = report.moved_out;
    statistics.dropped_in_solid = report.dropped_in_solid;
    statistics.removed_by_volume = report.removed_by_volume;
    statistics.thinned = report.thinned;
    statistics.used_distance_m = report.used_distance_m;
}

}  // namespace

tl::expected<Sector, std::string> bake_sector(World& world, map::SectorCoordinate coordinate, const Settings& settings) {
    const trace::FloatMode float_mode;
    // Placement looks over the border too, however short the reach.
    const auto scene = world.scene_for(coordinate, std::max(settings.reach_m, placement::decision_margin_m({settings.min_distance_m})));
    const auto samples = world.samples_for(settings);
    const placement::Surroundings surroundings = surroundings_of(*scene, settings.reach_m);
    auto placed = place(world, *scene, surroundings, coordinate, settings.min_distance_m);
    if (!placed) return tl::unexpected(placed.error());

    Sector sector;
    sector.i = coordinate.i;
    sector.j = coordinate.j;
    if (auto stored = store_positions(placed->probes, sector); !stored) return tl::unexpected(stored.error());
    std::vector<placement::Position> positions;  // as stored: all that follows is a function of these
    for (const Probe& probe : sector.probes) {
        const auto units = position_units(sector, probe);
        positions.emplace_back(units[0], units[1], units[2]);
    }

    std::vector<ProbeLight> lights(positions.size());
    placement::ProbeGrid grid;
    const auto integrate_all = [&] {
        tbb::parallel_for(std::size_t{0}, positions.size(), [&](std::size_t p) {
            const trace::FloatMode task_float_mode;
            lights[p] = integrate_probe(*scene, positions[p], *samples, {settings.bounces, settings.reach_m});
        });
    };
    const auto index_all = [&] {
        const trace::FloatMode task_float_mode;
        grid = placement::build_grid(coordinate.i, coordinate.j, positions, surroundings);
    };
    // Isolated: a thread that waits for the rest of its sector must not start another one in between.
    tbb::this_task_arena::isolate([&] { tbb::parallel_invoke(integrate_all, index_all); });

    store_report(placed->report, sector.statistics);
    for (std::size_t p = 0; p < lights.size(); ++p) {
        store_light(lights[p], sector.probes[p]);
        sector.statistics.rays += lights[p].rays;
        sector.statistics.back_hits += lights[p].back_hits;
    }
    sector.grid = {grid.z_origin_units, grid.cell_height_units, grid.cells};
    sector.bake = {settings.rays, settings.bounces, settings.reach_m, settings.min_distance_m, settings_key(settings).bytes};
    return sector;
}

tl::expected<std::vector<std::uint8_t>, std::string> encode_sector(const Sector& sector) {
    std::vector<std::uint8_t> bytes = write_sector(sector);
    for (const Finding& finding : validate_sector(bytes)) {
        if (finding.issue->severity != Severity::error) continue;
        return tl::unexpected(fmt::format("sector ({}, {}) does not pass validation: {} {} {}", sector.i, sector.j, finding.issue->code, finding.path, finding.message));
    }
    return bytes;
}

}  // namespace drtv::bake
