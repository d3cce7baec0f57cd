// What faces up in a column, and how much room there is above.
#pragma once

#include "placement/placement.h"

#include <span>
#include <vector>

namespace drtv::placement {

struct Floor {
    float z_m = 0;
    float free_m = 0;  // above; 0 inside of something
};

// From the bottom up. Of surfaces at one height it does not matter in which order they are. `hits` are from
// the top down.
[[nodiscard]] std::vector<Floor> floors_of(std::span<const ColumnHit> hits);

}  // namespace drtv::placement
