// Which sectors a map has: those with ground, some static surface over or under the sector's square, and
// those with a hand-placed probe.
#pragma once

#include "bakerd/map/map.h"

#include <drtv/conventions.h>

#include <compare>
#include <cstdint>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::map {

// World square [64 i, 64 i + 64) x [64 j, 64 j + 64).
struct SectorCoordinate {
    std::int32_t i = 0, j = 0;
    auto operator<=>(const SectorCoordinate&) const = default;
};

inline constexpr double sector_size_m = drtv::sector_size_m;

// Sorted by (j, i). What reaches over a border by mere rounding is not beyond it. Fails with a sentence when
// an object lies beyond the range of sector coordinates (+-16384) or the map covers more than 2^20 sectors.
[[nodiscard]] tl::expected<std::vector<SectorCoordinate>, std::string> sectors_of(const Map& map);

}  // namespace drtv::map
