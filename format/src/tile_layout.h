// Where the fields of a file of tiles stand (SPEC.md, section 9).
#pragma once

#include <drtv/sky_tile.h>

#include <cstddef>
#include <cstdint>
#include <tuple>

namespace drtv::tile_layout {

// Of the header.
inline constexpr std::size_t magic_at = 0;
inline constexpr std::size_t major_at = 4;
inline constexpr std::size_t minor_at = 6;
inline constexpr std::size_t size_at = 8;
inline constexpr std::size_t count_at = 12;
inline constexpr std::size_t header_bytes = 32;
inline constexpr std::size_t checksum_bytes = 8;

inline constexpr std::uint32_t magic = 0x4C545244;  // "DRTL"
inline constexpr std::uint16_t major_version = 1;

[[nodiscard]] inline std::size_t file_bytes(std::size_t count) {
    return header_bytes + count * sizeof(SkyTile) + checksum_bytes;
}

[[nodiscard]] inline bool is_before(const SkyTile& a, const SkyTile& b) {
    return std::tuple(a.j, a.i) < std::tuple(b.j, b.i);
}

}  // namespace drtv::tile_layout
