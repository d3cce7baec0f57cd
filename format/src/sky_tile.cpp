#include <drtv/sky_tile.h>

#include <algorithm>

namespace drtv {
namespace {

using ProbeFlags = std::array<bool, max_probes>;

ProbeFlags named_by_interiors(const SectorView& sector) {
    ProbeFlags named{};
    for (const StoredInterior& interior : sector.interiors)
        named[interior.probe] = true;
    return named;
}

// Of a column, the lowest probe that is not among those to pass over; ties go to the lower index.
std::uint8_t lowest_probe(const SectorView& sector, std::size_t column, const ProbeFlags& passed_over) {
    std::uint8_t lowest = no_probe;
    const auto height = [&](std::uint8_t p) { return sector.positions[p].position[2]; };
    for (std::size_t z = 0; z < grid_size; ++z) {
        const std::uint8_t p = sector.grid->cells[column + grid_size * grid_size * z];
        if (p >= sector.probe_count || passed_over[p])
            continue;
        const bool lower =
            lowest == no_probe || height(p) < height(lowest) || (height(p) == height(lowest) && p < lowest);
        if (lower)
            lowest = p;
    }
    return lowest;
}

std::uint8_t visibility_code(const VisibilityCodes& codes) {
    const int sum = std::max<int>(codes[0], 0) + std::max<int>(codes[1], 0) + std::max<int>(codes[2], 0);
    constexpr int whole = 3 * 32767;
    return static_cast<std::uint8_t>((sum * 255 + whole / 2) / whole);
}

}  // namespace

SkyTile sky_tile_of(const SectorView& sector) {
    SkyTile tile;
    tile.i = sector.i;
    tile.j = sector.j;
    tile.z_origin_units = sector.z_origin_units;
    tile.z_shift = sector.z_shift;
    const ProbeFlags indoors = named_by_interiors(sector);
    for (std::size_t column = 0; column < tile.visibility.size(); ++column) {
        std::uint8_t p = lowest_probe(sector, column, indoors);
        if (p == no_probe)
            p = lowest_probe(sector, column, {});
        const bool open = p == no_probe;
        tile.visibility[column] = open ? UINT8_MAX : visibility_code(sector.sky_visibility[p]);
        tile.height[column] = open ? 0 : sector.positions[p].position[2];
    }
    return tile;
}

double tile_height_m(const SkyTile& tile, std::size_t column) {
    const std::uint32_t above = std::uint32_t{tile.height[column]} << tile.z_shift;
    return (static_cast<double>(tile.z_origin_units) + above) * double{position_unit_m};
}

float tile_visibility(const SkyTile& tile, std::size_t column) {
    return static_cast<float>(tile.visibility[column]) / 255.0f;
}

float sky_factor(const SkyTile& tile, std::size_t x, std::size_t y, double z_m) {
    const std::size_t column = x + tile_size * y;
    const double above_m = z_m - tile_height_m(tile, column);
    // A height that is no number counts as on the ground.
    const float share = above_m > 0 ? static_cast<float>(std::min(above_m / double{tile_fade_m}, 1.0)) : 0.0f;
    const float hidden = 1 - tile_visibility(tile, column);
    return 1 - hidden * (1 - share);
}

}  // namespace drtv
