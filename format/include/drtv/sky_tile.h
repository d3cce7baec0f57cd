// How much of the sky's light gets down to the ground, by column: 16 x 16 values per sector, made of its
// probes and kept when the sector is dropped, so that what is far away, such as a forest, is not lit as if it
// stood in the open (M. Gilabert and N. Stefanov, "Deferred Radiance Transfer Volumes", GDC 2012, slides 57
// and 58). A file of tiles (SPEC.md, section 9; `drtv tiles`) has them for a whole world in the first frame.
//
// Pure functions, thread-safe. Only write_tiles, and an error's message, allocate. A tile costs some 5 us to
// make, a factor some nanoseconds to ask for.
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

inline constexpr std::size_t tile_size = 16;  // columns along each side, of 4 m: those of the grid
inline constexpr float tile_fade_m = 16;      // so far above a probe its column darkens nothing any more

// As it stands in a file, byte for byte. Column (x, y) stands at index x + 16 y. A column without a probe is
// open.
struct SkyTile {
    std::int32_t i = 0;
    std::int32_t j = 0;
    std::int32_t z_origin_units = 0;
    std::uint8_t z_shift = 0;
    std::array<std::uint8_t, 19> reserved{};
    std::array<std::uint8_t, tile_size * tile_size> visibility{};  // mean of v[0..2], 255: all of the sky
    std::array<std::uint16_t, tile_size * tile_size> height{};     // above z_origin, in units << z_shift

    bool operator==(const SkyTile&) const = default;
};
static_assert(sizeof(SkyTile) == 800);

// Of each column, the lowest probe that its cells name. Probes of interiors count only where there is no
// other.
[[nodiscard]] SkyTile sky_tile_of(const SectorView& sector);

// Of a column, in metres: where its probe stands. REQUIRES, also below: a column of the tile.
[[nodiscard]] double tile_height_m(const SkyTile& tile, std::size_t column);
// 0 to 1.
[[nodiscard]] float tile_visibility(const SkyTile& tile, std::size_t column);

// What is left of the open sky's ambient light at a height above the column, 0 to 1: 1 - (1 - v)(1 - h / 16
// m), h clamped to 0..16 m. REQUIRES: x, y < tile_size.
[[nodiscard]] float sky_factor(const SkyTile& tile, std::size_t x, std::size_t y, double z_m);

// The tiles that lie in a file's bytes, by (j, i). Any bytes are safe. On error `tiles` is left as it was.
// REQUIRES for success: `bytes` starts at a multiple of 4, else `misaligned`.
ReadStatus open_tiles(std::span<const std::uint8_t> bytes, std::span<const SkyTile>& tiles);

// The bytes of the file. REQUIRES: no two tiles of one sector, at most 5 million. Their order decides
// nothing.
[[nodiscard]] std::vector<std::uint8_t> write_tiles(std::span<const SkyTile> tiles);

// Null where there is none. REQUIRES: tiles by (j, i), as open_tiles gives them.
[[nodiscard]] const SkyTile* find_tile(std::span<const SkyTile> tiles, std::int32_t i, std::int32_t j);

}  // namespace drtv
