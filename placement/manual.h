// Hand-placed probes as placement sees them.
#pragma once

#include "placement/placement.h"

#include <span>
#include <vector>

namespace drtv::placement {

struct Manual {
    Position position;
    std::vector<const ClosedVolume*> interiors;  // that name it: it serves these alone
};

// An order that no change elsewhere in a sector disturbs much.
[[nodiscard]] bool is_before(const Position& a, const Position& b);

// Each place once, in that order.
[[nodiscard]] std::vector<Manual> manual_probes(std::span<const HandPlacedProbe> manual);

// Whether its light is meant for the position.
[[nodiscard]] bool serves(const Manual& probe, const Position& position);

}  // namespace drtv::placement
