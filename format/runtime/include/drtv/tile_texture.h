// Tiles of many sectors in one texture, for shaders (slides 57 and 58 of the talk, see drtv/light.h): a
// square of n x n sectors that wraps, so that a camera may move anywhere; sector (i, j) has the 16 x 16
// texels that begin at (16 (i mod n), 16 (j mod n)). A texel is two floats (RG32F): visibility, 0 to 1, and
// the height in metres above which a column begins to darken less. The shader's drtv_sky_factor reads them.
//
// Pure functions, thread-safe, no allocation. Cost: a microsecond per sector.
//
//     for (drtv::SectorId id : came_into_sight)
//         drtv::write_tile_texels(set.tile(id), id, 32, texels);     // then upload these 16 x 16
//     drtv::TileShaderInputs inputs = drtv::tile_shader_inputs(32, shader_inputs.snapped_camera);
#pragma once

#include <drtv/sector_set.h>
#include <drtv/sky_tile.h>

#include <array>
#include <cstdint>
#include <span>

namespace drtv {

// As DrtvTiles in the shaders.
struct TileShaderInputs {
    std::array<float, 2> camera{};  // column of the snapped camera, 0 to columns
    float columns = 0;              // along each side
    float camera_z = 0;             // metres
};

// `sectors` is n; `snapped_camera` is that of VolumeShaderInputs. REQUIRES: sectors >= 1; a camera in the
// world.
[[nodiscard]] TileShaderInputs tile_shader_inputs(std::uint32_t sectors, const Double3& snapped_camera);

// Where the sector's texels begin, x and y.
[[nodiscard]] std::array<std::uint32_t, 2> tile_texel(std::uint32_t sectors, SectorId id);

// Writes the sector's texels. A sector without a tile (null) is open.
// REQUIRES: texels.size() == (16 sectors)^2.
void write_tile_texels(const SkyTile* tile,
                       SectorId id,
                       std::uint32_t sectors,
                       std::span<std::array<float, 2>> texels);

}  // namespace drtv
