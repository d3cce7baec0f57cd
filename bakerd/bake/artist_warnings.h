// Sentences about what an artist hardly meant, found while a sector is baked. They name things of the map.
#pragma once

#include "bakerd/map/ground.h"
#include "bakerd/map/map.h"
#include "bakerd/trace/scene.h"
#include "placement/placement.h"

#include <drtv/sector.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace drtv::bake {

// Whether so many of its rays ended at the back of a one-sided surface that something stands inside out or
// open.
[[nodiscard]] bool has_many_back_hits(const Statistics& statistics);

// Hits by object of the map.
using BackHits = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// Of many back hits, with the object that most of them belong to.
void warn_of_back_hits(const map::Map& map,
                       const Sector& sector,
                       std::span<const BackHits> of_probes,
                       std::vector<std::string>& warnings);

// Where no probe sees more than a rim of sky, because one object lies high above nearly all of them: a dome
// or a lid that is meant to be the sky.
void warn_of_closed_sky(const trace::Scene& scene,
                        const Sector& sector,
                        std::span<const placement::Position> probes,
                        std::vector<std::string>& warnings);

// Of lamps in the sector whose every ray ends within centimetres, as inside the mesh of a bulb.
void warn_of_enclosed_lamps(const trace::Scene& scene,
                            map::SectorCoordinate sector,
                            std::vector<std::string>& warnings);

}  // namespace drtv::bake
