// Sentences about probes that stand where light does not come, or could not be placed.
#pragma once

#include "bakerd/map/ground.h"
#include "bakerd/map/map.h"
#include "bakerd/trace/scene.h"
#include "placement/placement.h"

#include <drtv/sector.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace drtv::bake {

// Of dark probes: of each that was placed by hand, and of the others how many, with the thing over the first.
void warn_of_dark_probes(const trace::Scene& scene,
                         const Sector& sector,
                         std::span<const placement::Position> probes,
                         std::vector<std::string>& warnings);

// Of a hand-placed probe that stands in a wall, in a solid or under ground: it stays.
void warn_of_buried_probe(const map::Map& map,
                          const placement::BuriedManual& buried,
                          std::vector<std::string>& warnings);

// Of a thing that is closed and looks outwards, and that most of the sector's ground lies inside of: a sky
// dome, or a hall whose faces are turned.
void warn_of_covered_ground(const trace::Scene& scene,
                            map::SectorCoordinate sector,
                            std::vector<std::string>& warnings);

// Of places for probes that lie in solids, with those in which most of them lie; `dropped_in` names one for
// each place.
void warn_of_empty_places(const map::Map& map,
                          map::SectorCoordinate sector,
                          std::span<const placement::Thing> dropped_in,
                          std::vector<std::string>& warnings);

}  // namespace drtv::bake
