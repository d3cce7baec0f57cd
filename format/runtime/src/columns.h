// Columns of 4 m, those of the grids of all sectors.
#pragma once

#include <drtv/sector_set.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace drtv {

inline constexpr double side_m = sector_size_m;
inline constexpr double cell_m = side_m / grid_size;

// Column of 4 m along one axis, of the whole world. REQUIRES: the place is finite.
struct Column {
    std::int64_t index;
    float above;  // share of the next one, 0 to 1, where columns are taken at their centres
};

// Whether a file can lie there at all: also, that cells can be counted.
[[nodiscard]] inline bool in_reach(double metres) {
    constexpr double reach_m = (double{max_sector_coordinate} + 2) * side_m;
    return std::abs(metres) <= reach_m;
}

[[nodiscard]] inline Column column_at(double metres, double first_centre) {
    const double cells = metres / cell_m - first_centre;
    const double low = std::floor(cells);
    return {static_cast<std::int64_t>(low), static_cast<float>(cells - low)};
}

[[nodiscard]] inline SectorId sector_of_columns(std::int64_t x, std::int64_t y) {
    constexpr int bits = 4;
    static_assert(std::size_t{1} << bits == grid_size);
    return {static_cast<std::int32_t>(x >> bits), static_cast<std::int32_t>(y >> bits)};
}

[[nodiscard]] inline std::int32_t modulo(std::int32_t n, std::int32_t length) {
    const std::int32_t rest = n % length;
    return rest < 0 ? rest + length : rest;
}

[[nodiscard]] inline std::size_t within_sector(std::int64_t column) {
    return static_cast<std::size_t>(column) % grid_size;
}

}  // namespace drtv
