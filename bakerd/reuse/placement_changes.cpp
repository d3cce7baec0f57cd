#include "bakerd/reuse/placement_changes.h"

#include <drtv/conventions.h>

#include <algorithm>
#include <bit>
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

// The grid's cells look for their probes all over the sector; columns stand on their lattices.
bool object_moves_probes(const Item& object, const Footprint& footprint) {
    const Bounds bounds = grown(object.bounds, glm::vec3(slack_m(object.bounds, footprint.reach_m)));
    const Bounds square = square_of(footprint.sector);
    if (overlap(bounds, square))
        return true;
    const bool vegetation = object.kind == ItemKind::vegetation;
    const auto lattice_m =
        static_cast<float>(vegetation ? placement::vegetation_lattice_m : placement::ground_lattice_m);
    const glm::vec3 margin(footprint.placement_m, footprint.placement_m, 0);
    return overlap(bounds, grown(square, margin)) && holds_lattice_point(bounds, lattice_m);
}

}  // namespace

std::optional<Cause> moves_probes(const Item& item, const Footprint& footprint) {
    const auto when = [](bool moves, Cause cause) { return moves ? std::optional(cause) : std::nullopt; };
    const auto within = [&](float metres) {
        return overlap(item.bounds, grown(square_of(footprint.sector), {metres, metres, 0}));
    };
    switch (item.kind) {
        case ItemKind::fixed:
        case ItemKind::vegetation:
            return when(object_moves_probes(item, footprint), Cause::placement);
        case ItemKind::manual_probe:
        case ItemKind::no_probes:
            // As far as candidates stand and may be moved, and keep their distance.
            return when(within(footprint.placement_m + 2 * footprint.min_distance_m), Cause::placement);
        case ItemKind::interior:
            return when(within(position_unit_m), Cause::interior);
        case ItemKind::lamp:
        case ItemKind::sun:
            return std::nullopt;
    }
    return Cause::placement;
}

SolidTestChanges::SolidTestChanges(const Footprint& footprint)
    : footprint_(footprint), rays_(footprint.solid_tests.size(), 0) {}

bool SolidTestChanges::add(std::span<const Bounds> boxes) {
    const std::span<const glm::vec3> directions = placement::solid_test_directions();
    const float reach_m = footprint_.reach_m;
    for (std::size_t n = 0; n < rays_.size(); ++n) {
        const bake::SolidTest& test = footprint_.solid_tests[n];
        const glm::vec3 place = placement::metres(test.position);
        const auto is_near = [&](const Bounds& box) { return distance(box, place) <= reach_m; };
        if (std::ranges::none_of(boxes, is_near))
            continue;
        for (std::size_t d = 0; d < directions.size(); ++d) {
            const auto is_met = [&](const Bounds& box) {
                return entry_distance(place, directions[d], box) <= reach_m;
            };
            const std::uint32_t bit = 1u << d;
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
    for (const std::uint32_t rays : rays_)
        counts.push_back(static_cast<std::uint8_t>(std::popcount(rays)));
    return counts;
}

}  // namespace drtv::reuse
