// Tiles of 8 x 8 sectors: what shares a scene, and so what is best baked one after the other.
#pragma once

#include "bakerd/map/ground.h"

namespace drtv::bake {

inline constexpr int tile_shift = 3;
inline constexpr int tile_sectors = 1 << tile_shift;  // along each axis

[[nodiscard]] constexpr map::SectorCoordinate tile_of(map::SectorCoordinate sector) {
    return {sector.i >> tile_shift, sector.j >> tile_shift};
}

}  // namespace drtv::bake
