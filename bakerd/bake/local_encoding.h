// Local transfer as the sector file holds it: the list of sources, and pairs in fixed point.
#pragma once

#include "bakerd/bake/local_transfer.h"
#include "bakerd/bake/placed_sector.h"

#include <drtv/sector.h>

#include <span>
#include <vector>

namespace drtv::bake {

struct LocalSources {
    std::vector<LocalSource> sources;  // own probes in their order, then neighbours' by j, i and index
    std::vector<placement::Position> positions;
    SourcesOfReceivers of_receivers;
};

// Of each probe of the sector: the 128 probes nearest to it, itself among them, of the sector and its
// neighbours, as far as the reach goes; ties by j, i and index.
[[nodiscard]] LocalSources local_sources(const PlacedSector& placed,
                                         std::span<const PlacedSector* const> neighbours,
                                         float reach_m);

// Pairs that round to nothing are left out. The codes of a pair are rounded to 8 significant bits of its
// largest.
[[nodiscard]] LocalTransfer encode_local(const LocalSources& sources, const LocalLight& light);

// The smallest exponent e, at least `least`, with |value| <= 2^e.
[[nodiscard]] int exponent_of(float value, int least);

}  // namespace drtv::bake
