// Where a stored position lies in the world (SPEC.md, section 5.2).
#pragma once

#include <drtv/conventions.h>

#include <array>
#include <cstdint>

namespace drtv {

// In units, exact. `Place` is a sector or a view of one.
template <class Place>
[[nodiscard]] std::array<std::int32_t, 3> units_of(const Place& sector,
                                                   const std::array<std::uint16_t, 3>& position) {
    constexpr std::int32_t side = sector_size_m * position_units_per_m;
    return {sector.i * side + position[0],
            sector.j * side + position[1],
            sector.z_origin_units + (std::int32_t{position[2]} << sector.z_shift)};
}

[[nodiscard]] inline Float3 metres_of(const std::array<std::int32_t, 3>& units) {
    return {static_cast<float>(units[0]) * position_unit_m,
            static_cast<float>(units[1]) * position_unit_m,
            static_cast<float>(units[2]) * position_unit_m};
}

}  // namespace drtv
