// One sector: place, integrate, encode. A pure function of the map's content within reach, the settings and
// the format version; the same bytes on any number of threads.
#pragma once

#include "bakerd/bake/assessment.h"
#include "bakerd/bake/footprint.h"
#include "bakerd/bake/settings.h"
#include "bakerd/bake/world.h"

#include <drtv/sector.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::bake {

struct BakedSector {
    Sector sector;
    std::vector<std::string> warnings;  // one sentence each, for the artist
    Footprint footprint;
    std::size_t probes_taken_over = 0;
};

// An earlier bake of the sector with the same settings, of another map, and what of it holds for the world at
// hand.
struct EarlierBake {
    Sector sector;
    Footprint footprint;
    Assessment assessment;
};

// Runs on the calling thread's TBB arena. Fails with a sentence (too many manual probes; too high a sector).
//
// Probes of an earlier bake that stand where they stood, and whose bound is within settings.tolerance, are
// taken over (REQUIRES: it was assessed with that tolerance); with bounds of 0 the result is the same, byte
// for byte, as without it.
[[nodiscard]] tl::expected<BakedSector, std::string> bake_sector(World& world,
                                                                 map::SectorCoordinate coordinate,
                                                                 const Settings& settings,
                                                                 const EarlierBake* earlier = nullptr);

// The sector file, checked by the validator; a sentence with the first error when it fails. What the
// validator warns of is added to `warnings`.
[[nodiscard]] tl::expected<std::vector<std::uint8_t>, std::string> encode_sector(
    const Sector& sector, std::vector<std::string>& warnings);

// The sector of a file; nothing when it cannot be read.
[[nodiscard]] std::optional<Sector> decode_sector(std::span<const std::uint8_t> bytes);

}  // namespace drtv::bake
