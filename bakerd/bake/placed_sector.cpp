#include "bakerd/bake/placed_sector.h"

#include "bakerd/bake/placement_scene.h"
#include "bakerd/bake/probe_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace drtv::bake {
namespace {

ProbeKind kind_of(placement::Kind kind) {
    switch (kind) {
        case placement::Kind::ground:
            return ProbeKind::ground;
        case placement::Kind::vegetation:
            return ProbeKind::vegetation;
        case placement::Kind::manual:
            return ProbeKind::manual;
    }
    return ProbeKind::ground;
}

// Heights in 16 bits against the lowest probe: steps of 2^-10 m where the sector's probes span up to 64 m,
// doubled as often as needed where they span more.
tl::expected<void, std::string> store_positions(const std::vector<placement::PlacedProbe>& probes,
                                                Sector& sector) {
    if (probes.empty())
        return {};
    const auto by_height = [](const placement::PlacedProbe& a, const placement::PlacedProbe& b) {
        return a.position.z < b.position.z;
    };
    const std::int32_t lowest = std::min_element(probes.begin(), probes.end(), by_height)->position.z;
    const std::int32_t highest = std::max_element(probes.begin(), probes.end(), by_height)->position.z;
    sector.z_origin_units = lowest;
    const auto step_of = [&](std::int32_t z) {
        return (std::int64_t{z} - lowest + ((1 << sector.z_shift) >> 1)) >> sector.z_shift;
    };
    while (step_of(highest) > 65535) {
        if (++sector.z_shift > max_z_shift)
            return tl::unexpected(fmt::format("sector ({}, {}): its probes span {} m of height",
                                              sector.i,
                                              sector.j,
                                              (std::int64_t{highest} - lowest) / position_units_per_m));
    }
    constexpr std::int32_t side = sector_size_m * position_units_per_m;
    for (const placement::PlacedProbe& placed : probes) {
        Probe probe;
        probe.position = {static_cast<std::uint16_t>(placed.position.x - sector.i * side),
                          static_cast<std::uint16_t>(placed.position.y - sector.j * side),
                          static_cast<std::uint16_t>(step_of(placed.position.z))};
        probe.kind = kind_of(placed.kind);
        sector.probes.push_back(probe);
    }
    return {};
}

float max_distance_m(const PlacementTags& tags, const settings::BakeSettings& settings) {
    float max_m = settings.min_distance_m;
    for (const placement::SpacingVolume& spacing : tags.spacings)
        max_m = std::max(max_m, spacing.min_distance_m);
    return max_m;
}

// How far around a sector placement looks down its columns.
float placement_margin_m(const PlacementTags& tags, const settings::BakeSettings& settings) {
    const float margin_m = placement::decision_margin_m({settings.min_distance_m}, tags.spacings);
    // The neighbours' probes are sources of local transfer.
    return settings.local_transfer ? margin_m + static_cast<float>(map::sector_size_m) : margin_m;
}

}  // namespace

float placement_reach_m(const PlacementTags& tags, const settings::BakeSettings& settings) {
    // As far as candidates stand, may be moved, and look for others at their distance.
    return placement_margin_m(tags, settings) + 2 * max_distance_m(tags, settings);
}

// Placement looks over the border, and from there, moved by some steps, as far as the reach goes.
float scene_distance_m(const PlacementTags& tags, const settings::BakeSettings& settings) {
    return settings.reach_m + placement_reach_m(tags, settings);
}

tl::expected<PlacedSector, std::string> place_sector(const PlacementTags& tags,
                                                     const trace::Scene& scene,
                                                     map::SectorCoordinate coordinate,
                                                     const settings::BakeSettings& settings) {
    const placement::PlacementSettings how{settings.min_distance_m};
    const glm::vec2 corner = glm::vec2(coordinate.i, coordinate.j) * static_cast<float>(map::sector_size_m);
    const float margin_m = placement::decision_margin_m(how, tags.spacings);
    std::vector<placement::Box> vegetation;
    for (const map::Bounds& bounds : scene.vegetation_bounds(
             {corner - margin_m, corner + static_cast<float>(map::sector_size_m) + margin_m}))
        vegetation.push_back({bounds.low, bounds.high});
    auto placement = placement::place_probes(
        {coordinate.i, coordinate.j, vegetation, tags.manual_probes, tags.no_probes, tags.spacings},
        queries_of(scene, settings.reach_m),
        how);
    if (!placement)
        return tl::unexpected(placement.error());

    PlacedSector placed;
    placed.sector.i = coordinate.i;
    placed.sector.j = coordinate.j;
    placed.report = placement->report;
    placed.solid_tests = std::move(placement->solid_tests);
    if (auto stored = store_positions(placement->probes, placed.sector); !stored)
        return tl::unexpected(stored.error());
    for (const Probe& probe : placed.sector.probes) {
        const auto units = position_units(placed.sector, probe);
        placed.positions.emplace_back(units[0], units[1], units[2]);
    }
    for (const placement::PlacedProbe& probe : placement->probes)
        placed.moved.push_back(probe.moved);
    for (const placement::BuriedManual& buried : placement->buried_manual)
        warn_of_buried_probe(scene.map(), buried, placed.warnings);
    warn_of_covered_ground(scene, coordinate, placed.warnings);
    warn_of_empty_places(scene.map(), coordinate, placement->dropped_in, placed.warnings);
    return placed;
}

}  // namespace drtv::bake
