// Local transfer as the sector file holds it: the list of sources, and pairs in fixed point.
#pragma once

#include "bakerd/bake/local_transfer.h"
#include "bakerd/bake/placed_sector.h"

#include <drtv/sector.h>

#include <span>
#include <vector>

namespace drtv::bake {

struct LocalSources {
    std::vector<LocalSource> sources;  // own probes in their order, then neighbours' by distance
    std::vector<placement::Position> positions;
};

// Up to 128 sources: all probes of the sector (even if they are more), then those of its neighbours by the
// distance to its nearest probe, as far as the reach goes.
[[nodiscard]] LocalSources local_sources(const PlacedSector& placed,
                                         std::span<const PlacedSector* const> neighbours,
                                         float reach_m);

// Receivers take their nearest 128 sources within reach. Pairs that round to nothing are left out. The codes
// of a pair are rounded to 8 significant bits of its largest.
[[nodiscard]] LocalTransfer encode_local(const LocalSources& sources,
                                         const LocalLight& light,
                                         std::size_t receiver_count,
                                         float reach_m);

// The smallest exponent e, at least `least`, with |value| <= 2^e.
[[nodiscard]] int exponent_of(float value, int least);

}  // namespace drtv::bake
