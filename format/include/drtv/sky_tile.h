// How much of the sky's light reaches the ground, per column: 16 x 16 values per sector. They are made from
// the sector's probes and kept when it is dropped, so that distant things, such as a forest, are not lit as
// if they stood in the open (M. Gilabert and N. Stefanov, "Deferred Radiance Transfer Volumes", GDC 2012,
// slides 57 and 58). A file of tiles (SPEC.md, section 9; `drtv tiles`) provides them for a whole world from
// the first frame on.
//
// Pure functions, thread-safe. Only write_tiles and error messages allocate. Making a tile costs some 5 us,
// asking for a factor some nanoseconds.
//
//     const drtv::SkyTile tile = drtv::sky_tile_of(sector);
//     const float factor = drtv::sky_factor(tile, 3, 5, height_m);   // of the open sky's ambient light
//
//     std::span<const drtv::SkyTile> tiles;
//     if (drtv::open_tiles(mapped_bytes, tiles).ok()) set.use_tiles(tiles);
#pragma once

#include <drtv/conventions.h>
#include <drtv/read.h>
#include <drtv/view.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace drtv {

inline constexpr std::size_t tile_size = 16;  // columns along each side, 4 m wide: those of the grid
inline constexpr float tile_fade_m = 16;      // at this height above its probe a column stops darkening

// As stored in a file, byte for byte. Column (x, y) has the index x + 16 y. A column without a probe counts
// as open sky.
struct SkyTile {
    std::int32_t i = 0;
    std::int32_t j = 0;
    std::int32_t z_origin_units = 0;
    std::uint8_t z_shift = 0;
    std::array<std::uint8_t, 19> reserved{};
    std::array<std::uint8_t, tile_size * tile_size> visibility{};  // mean of v[0..2], 255: all of the sky
    std::array<std::uint16_t, tile_size * tile_size> height{};     // over z_origin_units, in units << z_shift

    bool operator==(const SkyTile&) const = default;
};
static_assert(sizeof(SkyTile) == 800);

// Each column takes the lowest probe that its cells name. Probes that interiors name count only where the
// column has no other.
[[nodiscard]] SkyTile sky_tile_of(const SectorView& sector);

// World height of the column's probe, in metres. REQUIRES, also below: a column of the tile.
[[nodiscard]] double tile_height_m(const SkyTile& tile, std::size_t column);
// The part of the sky that the column's probe sees, 0 to 1.
[[nodiscard]] float tile_visibility(const SkyTile& tile, std::size_t column);

// What is left of the open sky's ambient light in a column at the world height z_m, 0 to 1. With h the height
// above the column's probe, clamped to 0..16 m, it is 1 - (1 - v)(1 - h / 16 m). REQUIRES: x, y < tile_size.
[[nodiscard]] float sky_factor(const SkyTile& tile, std::size_t x, std::size_t y, double z_m);

// Opens the tiles in a file's bytes, in place and sorted by (j, i). Any bytes are safe. On error `tiles` is
// left as it was. REQUIRES for success: `bytes` starts at a multiple of 4, else `misaligned`.
ReadStatus open_tiles(std::span<const std::uint8_t> bytes, std::span<const SkyTile>& tiles);

// The bytes of a file of these tiles, whose order does not matter. REQUIRES: no two tiles of one sector, at
// most 5 million.
[[nodiscard]] std::vector<std::uint8_t> write_tiles(std::span<const SkyTile> tiles);

// The tile of sector (i, j); null where there is none. REQUIRES: tiles by (j, i), as open_tiles gives them.
[[nodiscard]] const SkyTile* find_tile(std::span<const SkyTile> tiles, std::int32_t i, std::int32_t j);

}  // namespace drtv
