// The grid that finds the nearest probe (s17): 16 x 16 x 16 cells over the sector, one byte each.
#pragma once

#include "placement/placement.h"

#include <array>

namespace drtv::placement {

inline constexpr std::size_t grid_size = 16;
inline constexpr std::uint8_t no_probe = 255;

// Each cell prefers, of this many nearest probes, the nearest that its centre sees.
inline constexpr std::size_t considered_probes = 4;

struct ProbeGrid {
    std::int32_t z_origin_units = 0;                                      // bottom, 2^-10 m
    std::uint32_t cell_height_units = 1024;                               // 2^-10 m; cells are 4 m wide
    std::array<std::uint8_t, grid_size * grid_size * grid_size> cells{};  // index x + 16 y + 256 z
};

// Nearest by distance from the cell's centre, ties by index; of the four nearest the first one visible, else
// the nearest. REQUIRES: at most 255 positions.
[[nodiscard]] ProbeGrid build_grid(std::int32_t i,
                                   std::int32_t j,
                                   std::span<const Position> probes,
                                   const Surroundings& surroundings);

}  // namespace drtv::placement
