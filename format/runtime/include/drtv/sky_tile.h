// How much of the sky's light gets down to the ground, by column: 16 x 16 values per sector, made of its
// probes and kept when the sector is dropped, so that what is far away, such as a forest, is not lit as if it
// stood in the open (slides 57 and 58 of the talk, see drtv/light.h).
//
//     drtv::SkyTile tile = drtv::sky_tile_of(sector);
//     float factor = drtv::sky_factor(tile, 3, 5, height_m);   // of the open sky's ambient light
//
// Pure functions, thread-safe, no allocation. Making a tile costs some 10 us, a factor some nanoseconds.
#pragma once

#include <drtv/conventions.h>
#include <drtv/view.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace drtv {

inline constexpr std::size_t tile_size = 16;  // columns along each side, of 4 m: those of the grid
inline constexpr float tile_fade_m = 16;      // so far above a probe its column darkens nothing any more

// Column (x, y) stands at index x + 16 y. A column without a probe is open.
struct SkyTile {
    std::int32_t i = 0;
    std::int32_t j = 0;
    std::int32_t z_origin_units = 0;
    std::uint8_t z_shift = 0;
    std::array<std::uint8_t, tile_size * tile_size> visibility{};  // mean of v[0..2], 255: all of the sky
    std::array<std::uint16_t, tile_size * tile_size> height{};     // above z_origin, in units << z_shift

    bool operator==(const SkyTile&) const = default;
};

// Of each column, the lowest probe that its cells name. Probes of interiors count only where there is no
// other.
[[nodiscard]] SkyTile sky_tile_of(const SectorView& sector);

// What is left of the open sky's ambient light at a height above the column, 0 to 1: 1 - (1 - v)(1 - h / 16
// m), h clamped to 0..16 m. REQUIRES: x, y < tile_size.
[[nodiscard]] float sky_factor(const SkyTile& tile, std::size_t x, std::size_t y, double z_m);

}  // namespace drtv
