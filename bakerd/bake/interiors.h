// Interior volumes (slide 56): closed meshes whose inside uses one probe. An interior stands in the file of
// the sector that holds its probe, whole, wherever the mesh reaches.
#pragma once

#include "bakerd/map/ground.h"
#include "bakerd/map/map.h"
#include "placement/closed_volume.h"
#include "placement/placement.h"

#include <drtv/sector.h>

#include <optional>
#include <span>
#include <string>

#include <tl/expected.hpp>

namespace drtv::bake {

struct InteriorVolume {
    std::string name;
    std::optional<placement::Position>
        probe;                     // where it stands; nothing where the volume names none and none is inside
    map::SectorCoordinate sector;  // of its probe
    placement::ClosedVolume volume;  // the mesh
    Interior stored;                 // all but the probe's index
};

// The probe is the one that the volume names, else of those inside the one nearest to the middle of its
// bounds. Vertices are rounded to the finest steps of a power of two that span the mesh in 16 bits; triangles
// that become lines are left out. Fails with a sentence when it has over 65536 vertices or is over 65 km
// long. REQUIRES: `closed` was made of `volume`, which the map holds.
[[nodiscard]] tl::expected<InteriorVolume, std::string> make_interior(const map::Map& map,
                                                                      const map::VolumeNode& volume,
                                                                      const placement::ClosedVolume& closed);

// Of the probes as they are stored, the one that stood at that place. Manual ones are never given up, but
// heights are rounded. REQUIRES: there is one.
[[nodiscard]] std::size_t probe_at(const placement::Position& place,
                                   std::span<const placement::Position> positions);

// Puts those whose probe stands in the sector into it; `positions` are those of its probes. Fails with a
// sentence when they are too many for one file.
[[nodiscard]] tl::expected<void, std::string> store_interiors(std::span<const InteriorVolume> interiors,
                                                              std::span<const placement::Position> positions,
                                                              Sector& sector);

}  // namespace drtv::bake
