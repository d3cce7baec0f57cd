#include "bakerd/bake/placed_sector.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace drtv::bake {
namespace {

static_assert(placement::units_per_m == position_units_per_m && placement::sector_size_m == sector_size_m &&
              placement::max_probes == max_probes);

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
        return (z - lowest + ((1 << sector.z_shift) >> 1)) >> sector.z_shift;
    };
    while (step_of(highest) > 65535) {
        if (++sector.z_shift > max_z_shift)
            return tl::unexpected(fmt::format("sector ({}, {}): its probes span {} m of height",
                                              sector.i,
                                              sector.j,
                                              (highest - lowest) / position_units_per_m));
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

}  // namespace

float placement_margin_m(const Settings& settings) {
    const float margin_m = placement::decision_margin_m({settings.min_distance_m});
    // The neighbours' probes are sources of local transfer.
    return settings.local_transfer ? margin_m + static_cast<float>(map::sector_size_m) : margin_m;
}

// Placement looks over the border, and from there, moved by some steps, as far as the reach goes.
float scene_distance_m(const Settings& settings) {
    return settings.reach_m + placement_margin_m(settings) + settings.min_distance_m;
}

placement::Surroundings surroundings_of(const trace::Scene& scene,
                                        float reach_m,
                                        std::vector<SolidTest>* solid_tests) {
    placement::Surroundings surroundings;
    surroundings.column = [&scene](glm::vec2 at, std::vector<placement::ColumnHit>& hits) {
        std::vector<trace::ColumnHit> found;
        scene.column(at, found);
        hits.clear();
        for (const trace::ColumnHit& hit : found)
            hits.push_back({hit.z_m, hit.up_facing, hit.down_facing});
    };
    surroundings.backs_met = [&scene, reach_m, solid_tests](const glm::vec3& origin,
                                                            std::span<const glm::vec3> directions) {
        const auto meets_back = [&](const glm::vec3& direction) {
            const auto hit = scene.closest({origin, direction, reach_m});
            return hit && !hit->front && scene.surface(*hit, 0).absorbs;
        };
        const auto backs = static_cast<std::size_t>(std::ranges::count_if(directions, meets_back));
        if (solid_tests != nullptr)
            solid_tests->push_back(
                {placement::Position(glm::round(origin * static_cast<float>(placement::units_per_m))),
                 static_cast<std::uint8_t>(placement::backs_to_flip(backs))});
        return backs;
    };
    surroundings.sees = [&scene](const glm::vec3& from, const glm::vec3& to) {
        const float distance_m = glm::length(to - from);
        return distance_m <= 0 || !scene.occluded({from, (to - from) / distance_m, distance_m});
    };
    return surroundings;
}

tl::expected<PlacedSector, std::string> place_sector(const PlacementVolumes& volumes,
                                                     const trace::Scene& scene,
                                                     map::SectorCoordinate coordinate,
                                                     const Settings& settings) {
    const placement::Settings how{settings.min_distance_m};
    const glm::vec2 corner = glm::vec2(coordinate.i, coordinate.j) * static_cast<float>(map::sector_size_m);
    const float margin_m = placement::decision_margin_m(how);
    std::vector<placement::Box> vegetation;
    for (const map::Bounds& bounds : scene.vegetation_bounds(
             {corner - margin_m, corner + static_cast<float>(map::sector_size_m) + margin_m}))
        vegetation.push_back({bounds.low, bounds.high});
    PlacedSector placed;
    const auto placement = placement::place_probes(
        {coordinate.i, coordinate.j, vegetation, volumes.manual_probes, volumes.no_probes},
        surroundings_of(scene, settings.reach_m, &placed.solid_tests),
        how);
    if (!placement)
        return tl::unexpected(placement.error());

    placed.sector.i = coordinate.i;
    placed.sector.j = coordinate.j;
    placed.report = placement->report;
    if (auto stored = store_positions(placement->probes, placed.sector); !stored)
        return tl::unexpected(stored.error());
    for (const Probe& probe : placed.sector.probes) {
        const auto units = position_units(placed.sector, probe);
        placed.positions.emplace_back(units[0], units[1], units[2]);
    }
    return placed;
}

}  // namespace drtv::bake
