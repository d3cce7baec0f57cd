// Where a sector's probes stand, as its file will say: found for the sector itself, and for its neighbours,
// whose probes are sources of its local transfer.
#pragma once

#include "bakerd/map/ground.h"
#include "bakerd/trace/scene.h"
#include "placement/closed_volume.h"
#include "placement/placement.h"
#include "settings/bake_settings.h"

#include <drtv/sector.h>

#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::bake {

struct PlacedSector {
    Sector sector;  // coordinate, positions and kinds; all else is still empty
    std::vector<placement::Position>
        positions;            // of its probes, as stored: all that follows is a function of these
    std::vector<bool> moved;  // by probe: out of a solid
    placement::PlacementReport report;
    std::vector<placement::SolidTest> solid_tests;  // on which all this rests
    std::vector<std::string> warnings;              // one sentence each
};

// What placement asks of a map beyond its triangles.
struct PlacementTags {
    std::vector<placement::HandPlacedProbe> manual_probes;
    std::vector<placement::ClosedVolume> no_probes;
    std::vector<placement::SpacingVolume> spacings;
};

// How far around a sector something that changes may move its probes.
[[nodiscard]] float placement_reach_m(const PlacementTags& tags, const settings::BakeSettings& settings);

// How far around a sector its scene must reach.
[[nodiscard]] float scene_distance_m(const PlacementTags& tags, const settings::BakeSettings& settings);

// Fails with a sentence (too many manual probes; too high a sector). REQUIRES: the scene holds all within
// reach and within placement's margin of the sector.
[[nodiscard]] tl::expected<PlacedSector, std::string> place_sector(const PlacementTags& tags,
                                                                   const trace::Scene& scene,
                                                                   map::SectorCoordinate coordinate,
                                                                   const settings::BakeSettings& settings);

}  // namespace drtv::bake
