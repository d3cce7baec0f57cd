// Where a sector's probes stand, as its file will say: found for the sector itself, and for its neighbours,
// whose probes are sources of its local transfer.
#pragma once

#include "bakerd/bake/settings.h"
#include "bakerd/map/ground.h"
#include "bakerd/trace/scene.h"
#include "placement/closed_volume.h"
#include "placement/placement.h"

#include <drtv/sector.h>

#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::bake {

// A point of which placement asked whether it stands in a solid.
struct SolidTest {
    placement::Position position;
    std::uint8_t to_flip = 0;  // rays that would have to end otherwise for the answer to change

    bool operator==(const SolidTest&) const = default;
};

struct PlacedSector {
    Sector sector;  // coordinate, positions and kinds; all else is still empty
    std::vector<placement::Position>
        positions;  // of its probes, as stored: all that follows is a function of these
    placement::Report report;
    std::vector<SolidTest> solid_tests;  // on which all this rests
};

// What placement asks of a map beyond its triangles.
struct PlacementVolumes {
    std::span<const glm::dvec3> manual_probes;
    std::span<const placement::ClosedVolume> no_probes;
};

// How far around a sector placement looks down its columns.
[[nodiscard]] float placement_margin_m(const Settings& settings);

// How far around a sector its scene must reach.
[[nodiscard]] float scene_distance_m(const Settings& settings);

// With `solid_tests`, each is appended to it. REQUIRES: the functions are used while scene and tests live.
[[nodiscard]] placement::Surroundings surroundings_of(const trace::Scene& scene,
                                                      float reach_m,
                                                      std::vector<SolidTest>* solid_tests = nullptr);

// Fails with a sentence (too many manual probes; too high a sector). REQUIRES: the scene holds all within
// reach and within placement's margin of the sector.
[[nodiscard]] tl::expected<PlacedSector, std::string> place_sector(const PlacementVolumes& volumes,
                                                                   const trace::Scene& scene,
                                                                   map::SectorCoordinate coordinate,
                                                                   const Settings& settings);

}  // namespace drtv::bake
