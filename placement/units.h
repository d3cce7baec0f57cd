// Lengths in whole units of 2^-10 m, so that distances are compared exactly. Here for inlining.
#pragma once

#include "placement/placement.h"

#include <cmath>
#include <cstdint>

namespace drtv::placement {

// The nearest. REQUIRES: it fits in 32 bits.
[[nodiscard]] inline std::int32_t to_units(double m) {
    return static_cast<std::int32_t>(std::lround(m * units_per_m));
}

[[nodiscard]] inline Position to_position(const glm::dvec3& point) {
    return {to_units(point.x), to_units(point.y), to_units(point.z)};
}

[[nodiscard]] inline std::int64_t squared_units(float distance_m) {
    const double units = static_cast<double>(distance_m) * units_per_m;
    const std::int64_t whole = std::lround(units);
    return whole * whole;
}

[[nodiscard]] inline std::int64_t squared_distance(const Position& a, const Position& b) {
    const std::int64_t x = std::int64_t{a.x} - b.x;
    const std::int64_t y = std::int64_t{a.y} - b.y;
    const std::int64_t z = std::int64_t{a.z} - b.z;
    return x * x + y * y + z * z;
}

// The sector that a coordinate in units lies in, along its axis.
[[nodiscard]] inline std::int32_t sector_of(std::int32_t units) {
    constexpr std::int32_t side = sector_size_m * units_per_m;
    return units >= 0 ? units / side : -((-units + side - 1) / side);
}

}  // namespace drtv::placement
