// Gives up probes of a sector that holds more than a file can.
#pragma once

#include "placement/candidates.h"

#include <cstddef>
#include <span>
#include <vector>

namespace drtv::placement {

struct Thinned {
    std::vector<PlacedProbe> probes;
    float used_distance_m = 0;  // the minimal distance between them in the end
};

// Of a sector's own probes, by priority, those that stay when the minimal distance grows from
// `min_distance_m` by eighths until at most `max_count` fit. Neighbours do not see that, so a border may lose
// probes by it but never gain one too near. One probe is kept at any distance, so that growing is no way out
// for a sector that manual ones fill: with `max_count` 0, all are given up.
[[nodiscard]] Thinned thin(std::span<const Candidate> own, float min_distance_m, std::size_t max_count);

}  // namespace drtv::placement
