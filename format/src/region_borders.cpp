#include "region_borders.h"

#include "border_step.h"
#include "findings.h"
#include "layout.h"
#include "sentence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace drtv {
namespace {

// On real maps the largest ratio is below 3; where it is dim the step must be one that can be seen. Few
// probes inside prove nothing.
constexpr double max_step_ratio = 4;
constexpr double min_step = 0.05;
constexpr std::size_t min_steps_inside = 64;

// Of each pair of neighbours one is the other's in one of these directions.
constexpr std::array<Coordinate, 4> directions = {{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};

struct Border {
    std::size_t first;  // indices into the map's sectors
    std::size_t second;
    const RegionSector& a;
    const RegionSector& b;
};

void check_sources(const RegionMap& map, std::size_t n, RegionFindings& findings) {
    const RegionSector& sector = map.sectors[n];
    for (std::size_t s = 0; s < sector.local_sources.size(); ++s) {
        const LocalSource& source = sector.local_sources[s];
        const auto neighbour = map.by_place.find({sector.i + source.di, sector.j + source.dj});
        if (neighbour == map.by_place.end())
            continue;
        const std::size_t probes = map.sectors[neighbour->second].positions.size();
        if (source.probe < probes)
            continue;
        const layout::Place place{sector.local_offset, sector.local_raw};
        findings.add(
            n,
            {&issue::neighbour_source,
             place.at(layout::LocalTransferLayout::source_at(s)),
             "local_transfer.sources" + index(s),
             source.probe,
             sentence(
                 "is probe ", source.probe, " of sector ", text(neighbour->first), ", which has ", probes)});
    }
}

double squared_distance(const std::array<std::int32_t, 3>& a, const std::array<std::int32_t, 3>& b) {
    double squared = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double d = static_cast<double>(a[axis]) - static_cast<double>(b[axis]);
        squared += d * d;
    }
    return squared;
}

struct NearProbes {
    std::size_t p;
    std::size_t q;
    double distance_units;
};

// The first two probes, neither placed by hand, that are nearer to each other.
std::optional<NearProbes> find_nearer(const Border& border, double min_units) {
    const auto& [first, second, a, b] = border;
    for (std::size_t p = 0; p < a.positions.size(); ++p) {
        if (a.kinds[p] == ProbeKind::manual)
            continue;
        for (std::size_t q = 0; q < b.positions.size(); ++q) {
            if (b.kinds[q] == ProbeKind::manual)
                continue;
            const double squared = squared_distance(a.positions[p], b.positions[q]);
            if (squared < min_units * min_units)
                return NearProbes{p, q, std::sqrt(squared)};
        }
    }
    return std::nullopt;
}

// One finding a border says it.
void check_distance(const Border& border, RegionFindings& findings) {
    const auto& [first, second, a, b] = border;
    const float min_m = std::min(a.bake.min_distance_m, b.bake.min_distance_m);
    // Heights are rounded to steps, so that a distance may have lost one of each.
    const double min_units =
        static_cast<double>(min_m) * position_units_per_m - a.position_step_units - b.position_step_units;
    if (min_units <= 0)
        return;
    const auto near = find_nearer(border, min_units);
    if (!near)
        return;
    const double distance_m = near->distance_units / position_units_per_m;
    findings.add(first,
                 {&issue::neighbour_distance,
                  0,
                  probe_path(near->p) + ".position",
                  distance_m,
                  sentence("stands ",
                           distance_m,
                           " m from probe ",
                           near->q,
                           " of sector ",
                           text(coordinate_of(b)),
                           ", and the minimal distance is ",
                           min_m,
                           " m")});
}

void check_sections(const Border& border, RegionFindings& findings) {
    const auto& [first, second, a, b] = border;
    if (a.has_local_transfer == b.has_local_transfer || a.positions.empty() || b.positions.empty())
        return;
    const std::size_t without = a.has_local_transfer ? second : first;
    const RegionSector& with = a.has_local_transfer ? a : b;
    findings.add(without,
                 {&issue::neighbour_sections,
                  0,
                  "",
                  std::nullopt,
                  sentence("has no local transfer, and its neighbour ", text(coordinate_of(with)), " has")});
}

void check_step(const Border& border, std::size_t axis, RegionFindings& findings) {
    const auto& [first, second, a, b] = border;
    const BorderStep step = border_step(a, b, axis);
    if (step.steps_inside < min_steps_inside)
        return;
    const bool large = step.across > max_step_ratio * step.inside && step.across > min_step;
    if (!large)
        return;
    findings.add(first,
                 {&issue::neighbour_step,
                  0,
                  "",
                  step.across,
                  sentence("towards sector ",
                           text(coordinate_of(b)),
                           " light steps by ",
                           step.across,
                           " on average, inside the two by ",
                           step.inside)});
}

void check_border(const Border& border, const Coordinate& direction, RegionFindings& findings) {
    check_distance(border, findings);
    const auto [di, dj] = direction;
    if (di != 0 && dj != 0)
        return;
    check_sections(border, findings);
    check_step(border, di != 0 ? 0 : 1, findings);
}

}  // namespace

void check_borders(const RegionMap& map, RegionFindings& findings) {
    for (const auto& [place, n] : map.by_place) {
        check_sources(map, n, findings);
        for (const Coordinate& direction : directions) {
            const auto [di, dj] = direction;
            const auto neighbour = map.by_place.find({place.first + di, place.second + dj});
            if (neighbour == map.by_place.end())
                continue;
            const std::size_t other = neighbour->second;
            const Border border{n, other, map.sectors[n], map.sectors[other]};
            check_border(border, direction, findings);
        }
    }
}

}  // namespace drtv
