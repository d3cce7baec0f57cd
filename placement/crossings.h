// What a line through the scene crosses, as placement asks for it.
#pragma once

#include <compare>

namespace drtv::placement {

// One crossing of a vertical line with a static object, or with what bounds a volume. A closed part that
// looks outwards has one front, whatever its material says.
struct ColumnHit {
    float z_m = 0;
    bool up_facing = false;    // seen from above it is a front, or it has two fronts
    bool down_facing = false;  // seen from below it is a front, or it has two fronts
    bool wound_up = false;     // its corners are counter-clockwise seen from above, whatever its sides are
    bool body = false;         // of a closed part whose fronts look outwards

    auto operator<=>(const ColumnHit&) const = default;
};

// One crossing of a straight way.
struct Side {
    float distance_m = 0;
    bool front = false;  // the way comes from the counter-clockwise side
    bool sheet = false;  // it has two fronts, and is of no closed part that looks outwards
};

}  // namespace drtv::placement
