// Whether a change can move a sector's probes.
#pragma once

#include "bakerd/bake/world.h"
#include "bakerd/reuse/boxes.h"
#include "bakerd/reuse/footprint.h"
#include "bakerd/reuse/inventory.h"
#include "settings/bake_settings.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace drtv::reuse {

// Of all that placement gives a sector, and with local transfer its neighbours: where they are the same, so
// are the sector's positions and statistics. Nothing when some cannot be placed.
[[nodiscard]] std::optional<map::Digest> placement_digest(bake::World& world,
                                                          map::SectorCoordinate sector,
                                                          const settings::BakeSettings& settings);

enum class ProbesMove : std::uint8_t {
    no,
    maybe,  // placing the sector again tells
    yes,    // or the sector's grid changes, or its interiors
};

// Where placement looks around a sector, in either of two maps.
struct PlacementReach {
    float within_m = 0;                  // of the sector's border
    bool vegetation_everywhere = false;  // not at the points of the usual lattice alone
};

// Of the map that was baked and of the world at hand.
[[nodiscard]] PlacementReach placement_reach(const Footprint& footprint,
                                             const settings::BakeSettings& settings,
                                             const bake::World& world);

// What becomes of the probes when a thing is in one map alone. Solid tests are asked besides.
[[nodiscard]] ProbesMove moves_probes(const Item& item,
                                      const Footprint& footprint,
                                      const PlacementReach& reach);

// The tests for solids on which a placement rests. Each sends rays, and its answer holds until so many of
// them may end otherwise.
class SolidTestChanges {
  public:
    // REQUIRES: the footprint outlives it.
    explicit SolidTestChanges(const Footprint& footprint);

    // Counts the rays that meet one of the boxes in which something changed, each once. Whether an answer may
    // change.
    [[nodiscard]] bool add(std::span<const Bounds> boxes);

    // By test: the rays counted so far.
    [[nodiscard]] std::vector<std::uint8_t> counts() const;

  private:
    const Footprint& footprint_;
    std::vector<std::uint64_t> rays_;  // by test: those counted, a bit for each direction
};

}  // namespace drtv::reuse
