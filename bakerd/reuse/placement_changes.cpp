#include "bakerd/reuse/placement_changes.h"

#include "placement/solid_test.h"

#include <drtv/conventions.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace drtv::reuse {
namespace {

// The sector, at any height.
Bounds square_of(map::SectorCoordinate sector) {
    constexpr float side_m = static_cast<float>(map::sector_size_m);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const float x = static_cast<float>(sector.i) * side_m;
    const float y = static_cast<float>(sector.j) * side_m;
    return {{x, y, -infinity}, {x + side_m, y + side_m, infinity}};
}

// Whether a square of the plan holds a point of a lattice with `step_m` metres between points, the first in
// the middle of its square.
bool holds_lattice_point(const Bounds& bounds, float step_m) {
    const auto between = [step_m](float low, float high) {
        return std::floor((high - step_m / 2) / step_m) >= std::ceil((low - step_m / 2) / step_m);
    };
    return between(bounds.low.x, bounds.high.x) && between(bounds.low.y, bounds.high.y);
}

void add_placed(map::Hasher& hasher, const bake::PlacedSector& placed) {
    hasher.add_sized(placed.positions);
    for (std::size_t p = 0; p < placed.positions.size(); ++p) {
        hasher.add(placed.sector.probes[p].kind);
        hasher.add(static_cast<std::uint8_t>(placed.moved[p]));
    }
    hasher.add(placed.sector.z_origin_units);
    hasher.add(placed.sector.z_shift);
    const placement::PlacementReport& report = placed.report;
    for (const std::uint32_t count : {report.candidates,
                                      report.moved_out,
                                      report.dropped_in_solid,
                                      report.removed_by_volume,
                                      report.thinned})
        hasher.add(count);
    hasher.add(report.used_distance_m);
    for (const std::string& warning : placed.warnings)
        hasher.add_sized(warning);
}

}  // namespace

std::optional<map::Digest> placement_digest(bake::World& world,
                                            map::SectorCoordinate sector,
                                            const settings::BakeSettings& settings) {
    const auto scene = world.surroundings(sector, settings).scene;
    const std::int32_t around = settings.local_transfer ? 1 : 0;
    map::Hasher hasher;
    for (std::int32_t j = sector.j - around; j <= sector.j + around; ++j) {
        for (std::int32_t i = sector.i - around; i <= sector.i + around; ++i) {
            const bool is_there = world.has_sector({i, j});
            hasher.add(static_cast<std::uint8_t>(is_there));
            if (!is_there)
                continue;
            const auto placed = world.placed({i, j}, settings, *scene);
            if (!*placed)
                return std::nullopt;
            add_placed(hasher, **placed);
        }
    }
    return hasher.finish();
}

PlacementReach placement_reach(const Footprint& footprint,
                               const settings::BakeSettings& settings,
                               const bake::World& world) {
    const bake::PlacementTags& tags = world.placement_tags();
    return {std::max(footprint.placement_m, bake::placement_reach_m(tags, settings)),
            settings.min_distance_m < placement::ground_lattice_m || !tags.spacings.empty()};
}

// Whether something static is in the way between two probes, or two places of the grid, nobody notes: where
// it is or was, the sector is placed again.
ProbesMove moves_probes(const Item& item, const Footprint& footprint, const PlacementReach& reach) {
    if (item.kind == ItemKind::lamp || item.kind == ItemKind::sun)
        return ProbesMove::no;
    const Bounds bounds = grown(item.bounds, glm::vec3(slack_m(item.bounds, footprint.reach_m)));
    const auto within = [&](float metres) {
        return overlap(bounds, grown(square_of(footprint.sector), {metres, metres, 0}));
    };
    if (within(0) || (item.kind == ItemKind::interior && within(position_unit_m)))
        return ProbesMove::yes;
    const bool leaves_alone = item.kind == ItemKind::vegetation && !item.bounds_volume;
    const bool matters = !leaves_alone || reach.vegetation_everywhere ||
                         holds_lattice_point(bounds, placement::vegetation_lattice_m);
    return matters && within(reach.within_m) ? ProbesMove::maybe : ProbesMove::no;
}

SolidTestChanges::SolidTestChanges(const Footprint& footprint)
    : footprint_(footprint), rays_(footprint.solid_tests.size(), 0) {}

bool SolidTestChanges::add(std::span<const Bounds> boxes) {
    const std::span<const placement::Look> looks = placement::solid_test_looks();
    const float reach_m = footprint_.reach_m;
    assert(looks.size() <= 64);  // a bit for each
    for (std::size_t n = 0; n < rays_.size(); ++n) {
        const placement::SolidTest& test = footprint_.solid_tests[n];
        const glm::vec3 place = placement::metres(test.position);
        const auto is_near = [&](const Bounds& box) { return distance(box, place) <= reach_m; };
        if (std::ranges::none_of(boxes, is_near))
            continue;
        for (std::size_t d = 0; d < looks.size(); ++d) {
            const auto is_met = [&](const Bounds& box) {
                return entry_distance(place, looks[d].direction, box) <= reach_m;
            };
            const std::uint64_t bit = std::uint64_t{1} << d;
            if ((rays_[n] & bit) == 0 && std::ranges::any_of(boxes, is_met))
                rays_[n] |= bit;
        }
        if (std::popcount(rays_[n]) >= test.to_flip)
            return true;
    }
    return false;
}

std::vector<std::uint8_t> SolidTestChanges::counts() const {
    std::vector<std::uint8_t> counts;
    for (const std::uint64_t rays : rays_)
        counts.push_back(static_cast<std::uint8_t>(std::popcount(rays)));
    return counts;
}

}  // namespace drtv::reuse
