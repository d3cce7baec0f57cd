#include "region_borders.h"

#include "border_step.h"
#include "findings.h"
#include "layout.h"
#include "sentence.h"

#include <array>
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
                           " on average more than heights and sky tell, inside the two by ",
                           step.inside)});
}

void check_border(const Border& border, const Coordinate& direction, RegionFindings& findings) {
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
