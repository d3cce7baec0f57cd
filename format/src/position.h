// Where a stored position lies in the world (SPEC.md, section 5.2).
#pragma once

#include <drtv/conventions.h>

#include <array>
#include <cstdint>

namespace drtv {

using Units3 = std::array<std::int32_t, 3>;

// In units, exact. `Place` is a sector or a view of one.
template <class Place>
[[nodiscard]] Units3 units_of(const Place& sector, const std::array<std::uint16_t, 3>& position) {
    constexpr std::int32_t side = sector_size_m * position_units_per_m;
    const auto [x, y, z] = position;
    const std::int32_t height = std::int32_t{z} << sector.z_shift;
    return {sector.i * side + x, sector.j * side + y, sector.z_origin_units + height};
}

[[nodiscard]] inline Float3 metres_of(const Units3& units) {
    return {static_cast<float>(units[0]) * position_unit_m,
            static_cast<float>(units[1]) * position_unit_m,
            static_cast<float>(units[2]) * position_unit_m};
}

}  // namespace drtv
