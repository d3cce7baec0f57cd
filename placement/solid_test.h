// Whether a point stands inside a solid, by geometry alone: neither the material's sides nor the node's role
// count. Two rules together: it is inside what closed surfaces bound; or, for what is not closed (a rock
// without a bottom, ground seen from below), rays upward meet four in five times backs and none escapes.
#pragma once

#include "placement/placement.h"

#include <cstdint>
#include <optional>
#include <span>

namespace drtv::placement {

// Nearer to a surface than this a point counts as on it.
inline constexpr float wall_clearance_m = 0.02f;

// To its reach. Unit vectors, up first. Not for use before main().
[[nodiscard]] std::span<const Look> solid_test_looks();

struct StandsAt {
    Stand stand = Stand::free;
    Thing thing = 0;           // in or behind which; of one that does not stand free
    std::uint8_t to_flip = 0;  // of the looks, those that would have to end otherwise
};

// What holds of a point that is inside no closed surface, by what its looks met.
[[nodiscard]] StandsAt stands_by(const Met& met);

[[nodiscard]] StandsAt stands_at(const Position& position, const SceneQueries& queries);

}  // namespace drtv::placement
