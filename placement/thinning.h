// Gives up probes of a sector that holds more than a file can.
#pragma once

#include "placement/candidates.h"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace drtv::placement {

struct Thinned {
    std::vector<PlacedProbe> probes;
    float growth = 1;  // of the minimal distances, which all keep
};

// Of a sector's own probes, by priority, those that stay when the minimal distances grow by eighths until at
// most `max_count` fit; up to that many of the others then find room at the distances of the step before.
// Neighbours do not see that, so a border may lose probes by it but never gain one too
// near. As long as that helps, a probe takes the place of those alone that it sees. One probe is kept at any
// distance, so that growing is no way out for a sector that manual ones fill: with `max_count` 0, all are
// given up.
using Sees = std::function<bool(const Position&, const Position&)>;
[[nodiscard]] Thinned thin(std::span<const Candidate> own, std::size_t max_count, const Sees& sees);

}  // namespace drtv::placement
