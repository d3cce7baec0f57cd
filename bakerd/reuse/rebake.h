// A sector baked again after an edit: what still holds of an earlier result is given to the bake, and a
// record says what the new result rests on.
#pragma once

#include "bakerd/bake/sector_bake.h"
#include "bakerd/bake/world.h"
#include "bakerd/reuse/assessment.h"
#include "bakerd/reuse/footprint.h"
#include "settings/bake_settings.h"

#include <drtv/sector.h>

#include <cstddef>
#include <string>

#include <tl/expected.hpp>

namespace drtv::reuse {

// An earlier bake of the sector with the same settings, of another map, and what of it holds for the world at
// hand.
struct EarlierBake {
    Sector sector;
    Footprint footprint;
    Assessment assessment;
};

struct Rebake {
    bake::BakedSector baked;
    Footprint footprint;
    std::size_t probes_reused = 0;
};

// Bakes a sector and records its footprint. Fails with a sentence (bake::bake_sector).
//
// Probes of an earlier bake that stand where they stood, and whose bound is within the tolerance with which
// it was assessed, are reused; with bounds of 0 the sector is the same, byte for byte, as without it.
[[nodiscard]] tl::expected<Rebake, std::string> bake_and_record(bake::World& world,
                                                                map::SectorCoordinate coordinate,
                                                                const settings::BakeSettings& settings,
                                                                const EarlierBake* earlier = nullptr);

}  // namespace drtv::reuse
