// Offsets and sizes of format version 1, as SPEC.md tabulates them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace drtv::layout {

inline constexpr std::uint32_t magic = 0x56545244;  // "DRTV"
inline constexpr std::uint16_t major_version = 1;
inline constexpr std::uint16_t minor_version = 0;

inline constexpr std::size_t header_bytes = 64;
inline constexpr std::size_t entry_bytes = 32;
inline constexpr std::size_t alignment = 16;
inline constexpr std::size_t max_sections = 64;
inline constexpr std::size_t max_raw_section_bytes = std::size_t{1} << 24;

namespace header {
inline constexpr std::size_t magic = 0, major = 4, minor = 6, file_bytes = 8, section_count = 12, sector_i = 16,
                             sector_j = 20, z_origin = 24, probe_count = 28, z_shift = 30, reserved = 31, checksum = 56;
}
namespace entry {
inline constexpr std::size_t kind = 0, version = 2, codec = 4, reserved = 5, offset = 8, stored_bytes = 12,
                             raw_bytes = 16, reserved2 = 20, checksum = 24;
}

inline constexpr std::size_t bake_bytes = 48;
inline constexpr std::size_t position_bytes = 8;         // a probe
inline constexpr std::size_t sky_visibility_bytes = 8;   // a probe
inline constexpr std::size_t transfer_bytes = 96;        // a probe
inline constexpr std::size_t grid_header_bytes = 16;
inline constexpr std::size_t grid_bytes = grid_header_bytes + 4096;
inline constexpr std::size_t statistics_bytes = 40;

// Where the values of a section lie in the file. Inside a compressed section no byte stands for one value: the
// section's first byte has to do.
struct Place {
    std::uint64_t start = 0;
    bool raw = true;

    [[nodiscard]] constexpr std::uint64_t at(std::uint64_t n) const { return raw ? start + n : start; }
};

[[nodiscard]] constexpr std::size_t align(std::size_t offset) { return (offset + alignment - 1) / alignment * alignment; }

}  // namespace drtv::layout
