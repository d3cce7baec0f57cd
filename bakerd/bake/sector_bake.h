// One sector: place, integrate, encode. A pure function of the map's content within reach, the settings and
// the format version; the same bytes on any number of threads.
#pragma once

#include "bakerd/bake/placed_sector.h"
#include "bakerd/bake/probe_encoding.h"
#include "bakerd/bake/ray_watch.h"
#include "bakerd/bake/stage_seconds.h"
#include "bakerd/bake/world.h"
#include "settings/bake_settings.h"

#include <drtv/sector.h>

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::bake {

struct ByPlace {
    bool operator()(const placement::Position& a, const placement::Position& b) const {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    }
};

// What of the sector is known before it is baked: it is stored as it is.
struct Given {
    // The grid of the same placement, and what counts are kept of it.
    struct IndexedGrid {
        Grid grid;
        std::uint32_t buried_cells = 0;
        std::uint32_t blind_cells = 0;
    };

    std::optional<PlacedSector> placement;
    std::optional<IndexedGrid> grid;
    std::map<placement::Position, BakedProbe, ByPlace> probes;  // those that stand elsewhere are not used
};

struct BakedSector {
    Sector sector;
    std::vector<std::string> warnings;  // one sentence each, for the artist
    // What the file does not say of its probes, in their order.
    std::vector<placement::Position> positions;
    std::vector<ProbeCounts> counts;
    // On which its placement rests, and with local transfer its neighbours'; by place, one of each.
    std::vector<placement::SolidTest> solid_tests;
    std::vector<std::string> placement_warnings;  // of `warnings`, those that follow from the placement
    StageSeconds seconds;                         // all but those of `files`
};

// Runs on the calling thread's TBB arena. Fails with a sentence (too many manual probes; too high a sector).
// `watch` is told of every ray of the probes that are not given, on the thread that traces it; not of
// placement's.
[[nodiscard]] tl::expected<BakedSector, std::string> bake_sector(World& world,
                                                                 map::SectorCoordinate coordinate,
                                                                 const settings::BakeSettings& settings,
                                                                 const Given& given = {},
                                                                 const WatchOfThread& watch = {});

}  // namespace drtv::bake
