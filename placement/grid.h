// The grid that finds a position's probe (slide 17): 16 x 16 x 16 cells over the sector, one byte each.
#pragma once

#include "placement/placement.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace drtv::placement {

struct ProbeGrid {
    std::int32_t z_origin_units = 0;                    // bottom, 2^-10 m
    std::uint32_t cell_height_units = 1024;             // 2^-10 m; cells are 4 m wide
    std::array<std::uint8_t, grid_cell_count> cells{};  // index x + 16 y + 256 z

    std::uint32_t buried_cells = 0;  // that stand in solids
    std::uint32_t blind_cells = 0;   // of the others, those that see none of the probes they may name
};

struct GridProbe {
    Position position;
    // One that interiors name is named by cells inside of one of them alone.
    std::vector<const ClosedVolume*> interiors;
};

// A cell is asked at four points, a quarter of its size from its sides, at every second corner. One that is
// in a solid is raised to the solid's surface where that is still in the cell, and else does not count. The
// cell names the nearest probe that at least half of its points see, else the one that most of them see;
// where none sees any, the same past leaves and glass, else the nearest. Distances are those from its centre,
// ties go by index. With no probe that it may name it holds `no_probe`. REQUIRES: at most 255 probes.
[[nodiscard]] ProbeGrid build_grid(std::int32_t i,
                                   std::int32_t j,
                                   std::span<const GridProbe> probes,
                                   const SceneQueries& queries);

}  // namespace drtv::placement
