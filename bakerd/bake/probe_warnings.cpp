#include "bakerd/bake/probe_warnings.h"

#include "bakerd/bake/interiors.h"
#include "bakerd/bake/probe_encoding.h"
#include "bakerd/bake/shown_names.h"
#include "placement/candidates.h"
#include "placement/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

namespace drtv::bake {
namespace {

// "the probe 'name' at (1.00, 2.00, 3.00)"
std::string shown_probe(const map::ProbeNode& probe) {
    return fmt::format("the probe {} at {}", shown_name(probe.name, "one"), shown_place(probe.position));
}

// What is above a place, to tell where it is.
std::string shown_cover(const trace::Scene& scene, const glm::vec3& place, float reach_m) {
    const auto hit = scene.closest({place, {0, 0, 1}, reach_m});
    return hit ? " under " + shown_object(scene.map(), scene.object_index(hit->instance)) : "";
}

const char* how_it_stands(placement::Stand stand) {
    switch (stand) {
        case placement::Stand::in_wall:
            return "in a wall:";
        case placement::Stand::behind:
            return "under the ground, or behind the faces of";
        case placement::Stand::free:
        case placement::Stand::in_solid:
            break;
    }
    return "inside";
}

// Whether it stands there, as it is stored.
bool is_probe(const map::ProbeNode& probe, std::size_t p, std::span<const placement::Position> probes) {
    const placement::Position place = placement::to_position(probe.position);
    return probes[p].x == place.x && probes[p].y == place.y && probe_at(place, probes) == p;
}

}  // namespace

void warn_of_dark_probes(const trace::Scene& scene,
                         const Sector& sector,
                         std::span<const placement::Position> probes,
                         std::vector<std::string>& warnings) {
    std::size_t dark = 0;
    std::size_t first = 0;
    for (std::size_t p = 0; p < probes.size(); ++p) {
        if (!is_dark(sector, p))
            continue;
        if (sector.probes[p].kind != ProbeKind::manual) {
            first = dark == 0 ? p : first;
            ++dark;
            continue;
        }
        for (const map::ProbeNode& probe : scene.map().probes) {
            if (is_probe(probe, p, probes))
                warnings.push_back(shown_probe(probe) + " is dark: no light of the map and no sky reach it");
        }
    }
    if (dark == 0)
        return;
    const glm::vec3 place = placement::metres(probes[first]);
    warnings.push_back(
        fmt::format("sector ({}, {}): {} {} dark, no light of the map and no sky reach {}: {} at {}{}",
                    sector.i,
                    sector.j,
                    dark,
                    dark == 1 ? "probe is" : "probes are",
                    dark == 1 ? "it" : "them",
                    dark == 1 ? "it stands" : "the first stands",
                    shown_place(place),
                    shown_cover(scene, place, sector.bake.reach_m)));
}

void warn_of_buried_probe(const map::Map& map,
                          const placement::BuriedManual& buried,
                          std::vector<std::string>& warnings) {
    for (const map::ProbeNode& probe : map.probes) {
        if (placement::to_position(probe.position) != buried.position)
            continue;
        warnings.push_back(fmt::format(
            "{} stands {} {}{}",
            shown_probe(probe),
            how_it_stands(buried.stand),
            shown_object(map, buried.thing),
            buried.stand == placement::Stand::in_solid ? ", whose faces are closed and look outwards" : ""));
    }
}

void warn_of_covered_ground(const trace::Scene& scene,
                            map::SectorCoordinate sector,
                            std::vector<std::string>& warnings) {
    constexpr std::int32_t lines = 8;  // along each axis
    constexpr float side_m = static_cast<float>(map::sector_size_m);
    std::size_t grounds = 0;
    std::map<std::uint32_t, std::size_t> covered;  // by thing
    std::vector<placement::ColumnHit> hits;
    for (std::int32_t n = 0; n < lines * lines; ++n) {
        const glm::vec2 share = (glm::vec2(n % lines, n / lines) + 0.5f) / float{lines};
        const glm::vec2 at = (glm::vec2(sector.i, sector.j) + share) * side_m;
        scene.column(at, hits);
        const auto floor =
            std::ranges::find_if(hits.rbegin(), hits.rend(), [](const placement::ColumnHit& hit) {
                return hit.up_facing && !hit.body;
            });
        if (floor == hits.rend())
            continue;
        ++grounds;
        if (const auto thing = scene.closed_around(glm::vec3(at, floor->z_m + placement::probe_height_m)))
            ++covered[*thing];
    }
    for (const auto& [thing, count] : covered) {
        if (2 * count <= grounds)
            continue;
        warnings.push_back(fmt::format(
            "sector ({}, {}): most of its ground lies inside {}, which is closed and looks outwards, "
            "and has no probes: leave a sky dome out of the bake with bake_role 'ignore', and turn the "
            "faces of a hall inwards",
            sector.i,
            sector.j,
            shown_object(scene.map(), thing)));
    }
}

void warn_of_empty_places(const map::Map& map,
                          map::SectorCoordinate sector,
                          std::span<const placement::Thing> dropped_in,
                          std::vector<std::string>& warnings) {
    if (dropped_in.empty())
        return;
    std::map<std::string, std::size_t> by_name;
    for (const placement::Thing thing : dropped_in)
        ++by_name[shown_object(map, thing)];
    std::vector<std::pair<std::string, std::size_t>> most(by_name.begin(), by_name.end());
    std::ranges::stable_sort(most, std::greater(), [](const auto& entry) { return entry.second; });
    constexpr std::size_t max_named = 3;
    std::string names;
    for (std::size_t n = 0; n < most.size() && n < max_named; ++n)
        names += fmt::format("{}{} ({})", n == 0 ? "" : ", ", most[n].first, most[n].second);
    if (most.size() > max_named)
        names += fmt::format(" and {} more", most.size() - max_named);
    warnings.push_back(
        fmt::format("sector ({}, {}): {} {} in solids and {} empty: {}",
                    sector.i,
                    sector.j,
                    dropped_in.size(),
                    dropped_in.size() == 1 ? "place for a probe lies" : "places for probes lie",
                    dropped_in.size() == 1 ? "stays" : "stay",
                    names));
}

}  // namespace drtv::bake
