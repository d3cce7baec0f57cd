// Which sector of a region lies where.
#pragma once

#include <drtv/validate_region.h>

#include "sentence.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>

namespace drtv {

using Coordinate = std::pair<std::int32_t, std::int32_t>;  // (i, j)

[[nodiscard]] inline Coordinate coordinate_of(const RegionSector& sector) {
    return {sector.i, sector.j};
}
// "(2, -1)"
[[nodiscard]] inline std::string text(const Coordinate& place) {
    return sentence("(", place.first, ", ", place.second, ")");
}

struct RegionMap {
    std::span<const RegionSector> sectors;
    std::map<Coordinate, std::size_t> by_place;  // index into `sectors`; the first of those at one place
    std::set<Coordinate> unreadable;             // places of files that cannot be read
};

}  // namespace drtv
