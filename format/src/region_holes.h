// Holes of a region: empty places with sectors all around.
#pragma once

#include "region_map.h"

#include <cstddef>
#include <set>
#include <vector>

namespace drtv {

struct Hole {
    Coordinate first;  // its southernmost place, of these the westernmost
    std::size_t size_sectors = 0;
};

// Empty places that no way over empty places, side by side, leads out of; each hole once. Around sectors that
// touch, holes are looked for where the rectangle around them has at most 2^22 places (131 x 131 km).
[[nodiscard]] std::vector<Hole> find_holes(const std::set<Coordinate>& sectors);

}  // namespace drtv
