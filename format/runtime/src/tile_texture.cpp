#include <drtv/tile_texture.h>

#include "columns.h"

#include <cmath>

namespace drtv {

TileShaderInputs tile_shader_inputs(std::uint32_t sectors, const Double3& snapped_camera) {
    const double columns = double{tile_size} * sectors;
    TileShaderInputs inputs;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const double column = snapped_camera[axis] / cell_m;
        inputs.camera[axis] = static_cast<float>(column - columns * std::floor(column / columns));
    }
    inputs.columns = static_cast<float>(columns);
    inputs.camera_z = static_cast<float>(snapped_camera[2]);
    return inputs;
}

std::array<std::uint32_t, 2> tile_texel(std::uint32_t sectors, SectorId id) {
    const auto within = [n = static_cast<std::int32_t>(sectors)](std::int32_t sector) {
        return static_cast<std::uint32_t>(modulo(sector, n)) * static_cast<std::uint32_t>(tile_size);
    };
    return {within(id.i), within(id.j)};
}

void write_tile_texels(const SkyTile* tile,
                       SectorId id,
                       std::uint32_t sectors,
                       std::span<std::array<float, 2>> texels) {
    const auto [x0, y0] = tile_texel(sectors, id);
    const std::size_t across = tile_size * std::size_t{sectors};
    for (std::size_t n = 0; n < tile_size * tile_size; ++n) {
        std::array<float, 2>& texel = texels[x0 + n % tile_size + across * (y0 + n / tile_size)];
        texel = {1, 0};
        if (tile != nullptr)
            texel = {tile_visibility(*tile, n), static_cast<float>(tile_height_m(*tile, n))};
    }
}

}  // namespace drtv
