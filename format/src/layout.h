// Offsets and sizes of format version 1, as SPEC.md tabulates them. Long because each section has its table.
#pragma once

#include <drtv/sector.h>
#include <drtv/version.h>

#include <cstddef>
#include <cstdint>

namespace drtv::layout {

inline constexpr std::uint32_t magic = 0x56545244;  // "DRTV"
inline constexpr std::uint16_t major_version = 1;
// Of a file with the sections 7 to 9, or some of them; a file without is one of version 1.0, byte for byte.
// In a file of version 1.0 the kinds 7 to 9 are unused: what they hold there is anything.
inline constexpr std::uint16_t minor_with_light_sections = 1;
// Likewise of a file with interiors, or with local transfer of version 2 (filtered).
inline constexpr std::uint16_t minor_with_interiors = 2;
inline constexpr std::uint16_t filtered_local_version = 2;
// Likewise of a file with light groups or quality, or with local transfer of version 3 (of many sources).
inline constexpr std::uint16_t minor_with_light_groups = 3;
inline constexpr std::uint16_t many_sources_local_version = 3;
static_assert(minor_with_light_groups == DRTV_FORMAT_MINOR, "drtv/version.h says what the library knows");

inline constexpr std::size_t header_bytes = 64;
inline constexpr std::size_t entry_bytes = 32;
inline constexpr std::size_t alignment = 16;
inline constexpr std::size_t max_sections = 64;
inline constexpr std::size_t max_raw_section_bytes = std::size_t{1} << 24;

namespace header {
inline constexpr std::size_t magic = 0;
inline constexpr std::size_t major = 4;
inline constexpr std::size_t minor = 6;
inline constexpr std::size_t file_bytes = 8;
inline constexpr std::size_t section_count = 12;
inline constexpr std::size_t sector_i = 16;
inline constexpr std::size_t sector_j = 20;
inline constexpr std::size_t z_origin = 24;
inline constexpr std::size_t probe_count = 28;
inline constexpr std::size_t z_shift = 30;
inline constexpr std::size_t reserved = 31;
inline constexpr std::size_t checksum = 56;
}  // namespace header
namespace entry {
inline constexpr std::size_t kind = 0;
inline constexpr std::size_t version = 2;
inline constexpr std::size_t codec = 4;
inline constexpr std::size_t reserved = 5;
inline constexpr std::size_t offset = 8;
inline constexpr std::size_t stored_bytes = 12;
inline constexpr std::size_t raw_bytes = 16;
inline constexpr std::size_t reserved2 = 20;
inline constexpr std::size_t checksum = 24;
}  // namespace entry

// Where line n of the table of sections stands in the file.
[[nodiscard]] constexpr std::size_t entry_at(std::size_t n) {
    return header_bytes + n * entry_bytes;
}

namespace bake {
inline constexpr std::size_t rays = 0;
inline constexpr std::size_t bounces = 4;
inline constexpr std::size_t reach = 8;
inline constexpr std::size_t min_distance = 12;
inline constexpr std::size_t settings_key = 16;
inline constexpr std::size_t bytes = 48;
}  // namespace bake
namespace position {  // of a probe
inline constexpr std::size_t axes = 0;
inline constexpr std::size_t kind = 6;
inline constexpr std::size_t reserved = 7;
inline constexpr std::size_t bytes = 8;
}  // namespace position
inline constexpr std::size_t sky_visibility_bytes = 8;  // of a probe
inline constexpr std::size_t transfer_bytes = 96;       // of a probe
namespace grid {
inline constexpr std::size_t z_origin = 0;
inline constexpr std::size_t cell_height = 4;
inline constexpr std::size_t reserved = 8;
inline constexpr std::size_t cells = 16;
inline constexpr std::size_t bytes = cells + grid_cell_count;
}  // namespace grid
namespace statistics {
inline constexpr std::size_t candidates = 0;
inline constexpr std::size_t moved_out = 4;
inline constexpr std::size_t dropped_in_solid = 8;
inline constexpr std::size_t removed_by_volume = 12;
inline constexpr std::size_t thinned = 16;
inline constexpr std::size_t used_distance = 20;
inline constexpr std::size_t rays = 24;
inline constexpr std::size_t back_hits = 32;
inline constexpr std::size_t bytes = 40;
}  // namespace statistics
namespace convergence {
inline constexpr std::size_t error_asked = 0;
inline constexpr std::size_t error_median = 4;
inline constexpr std::size_t error_p95 = 8;
inline constexpr std::size_t error_max = 12;
inline constexpr std::size_t paths_least = 16;
inline constexpr std::size_t paths_most = 20;
inline constexpr std::size_t local_bounces = 24;
inline constexpr std::size_t local_rays = 28;
inline constexpr std::size_t static_rays = 32;
inline constexpr std::size_t local_transfer_rays = 40;
inline constexpr std::size_t bytes = 48;
}  // namespace convergence

[[nodiscard]] constexpr std::size_t align(std::size_t offset) {
    return (offset + alignment - 1) / alignment * alignment;
}

inline constexpr std::size_t light_codes_bytes = 24;  // i16 [3][4]
inline constexpr std::size_t static_irradiance_bytes =
    light_codes_bytes + 1;  // a probe; all codes, then all exponents

// Local transfer: header, sources, receivers, masks, codes; each part starts at a multiple of 16.
struct LocalTransferLayout {
    static constexpr std::size_t source_count = 0;
    static constexpr std::size_t mask_size = 2;
    static constexpr std::size_t pair_count = 4;
    static constexpr std::size_t reserved = 8;
    static constexpr std::size_t header_bytes = 16;
    static constexpr std::size_t source_bytes = 4;
    static constexpr std::size_t receiver_bytes = 8;
    // Within a source's entry.
    static constexpr std::size_t di = 0;
    static constexpr std::size_t dj = 1;
    static constexpr std::size_t probe = 2;
    static constexpr std::size_t source_exponent = 3;
    // Within a receiver's.
    static constexpr std::size_t first_pair = 0;
    static constexpr std::size_t receiver_exponent = 4;
    static constexpr std::size_t receiver_reserved = 5;

    // Of a section of that version.
    [[nodiscard]] static constexpr std::size_t max_sources(std::uint16_t section_version) {
        return section_version == many_sources_local_version ? max_sector_sources : max_probes;
    }

    std::size_t sources_end;
    std::size_t receivers;
    std::size_t receivers_end;
    std::size_t masks;
    std::size_t codes;
    std::size_t end;

    constexpr LocalTransferLayout(std::size_t probe_count, std::size_t sources, std::size_t pairs)
        : sources_end(header_bytes + sources * source_bytes),
          receivers(align(sources_end)),
          receivers_end(receivers + probe_count * receiver_bytes),
          masks(align(receivers_end)),
          codes(masks + probe_count * local_mask_bytes(sources)),
          end(codes + pairs * light_codes_bytes) {}

    // Behind the codes of a filtered section: 26 bytes per pair, not 24.
    [[nodiscard]] constexpr std::size_t filtered_end(std::size_t pairs) const {
        return codes + pairs * filtered_pair_bytes;
    }
    static constexpr std::size_t filtered_pair_bytes = 2 + light_codes_bytes;

    [[nodiscard]] static constexpr std::size_t source_at(std::size_t s) {
        return header_bytes + s * source_bytes;
    }
    [[nodiscard]] constexpr std::size_t receiver_at(std::size_t p) const {
        return receivers + p * receiver_bytes;
    }
    [[nodiscard]] constexpr std::size_t pair_at(std::size_t n) const { return codes + n * light_codes_bytes; }
};

// Interiors: header, one entry an interior, all vertices, all triangles; each part starts at a multiple
// of 16.
struct InteriorsLayout {
    static constexpr std::size_t interior_count = 0;
    static constexpr std::size_t reserved = 2;
    static constexpr std::size_t vertex_count = 4;
    static constexpr std::size_t triangle_count = 8;
    static constexpr std::size_t reserved2 = 12;
    static constexpr std::size_t header_bytes = 16;
    static constexpr std::size_t entry_bytes = 32;
    static constexpr std::size_t vertex_bytes = 6;
    static constexpr std::size_t triangle_bytes = 6;
    // Within an entry.
    static constexpr std::size_t origin = 0;
    static constexpr std::size_t shift = 12;
    static constexpr std::size_t probe = 13;
    static constexpr std::size_t entry_reserved = 14;
    static constexpr std::size_t first_vertex = 16;
    static constexpr std::size_t vertices_of = 20;
    static constexpr std::size_t first_triangle = 24;
    static constexpr std::size_t triangles_of = 28;

    std::size_t vertices;
    std::size_t vertices_end;
    std::size_t triangles;
    std::size_t end;

    constexpr InteriorsLayout(std::size_t interior_count_,
                              std::size_t vertex_count_,
                              std::size_t triangle_count_)
        : vertices(header_bytes + interior_count_ * entry_bytes),
          vertices_end(vertices + vertex_count_ * vertex_bytes),
          triangles(align(vertices_end)),
          end(triangles + triangle_count_ * triangle_bytes) {}

    [[nodiscard]] static constexpr std::size_t entry_at(std::size_t n) {
        return header_bytes + n * entry_bytes;
    }
    [[nodiscard]] constexpr std::size_t triangle_at(std::size_t n) const {
        return triangles + n * triangle_bytes;
    }
};

// Light groups: header, names, all groups' codes, all groups' exponents.
struct LightGroupsLayout {
    static constexpr std::size_t group_count = 0;
    static constexpr std::size_t reserved = 2;
    static constexpr std::size_t header_bytes = 16;
    static constexpr std::size_t name_bytes = max_light_group_name + 1;

    std::size_t probes;
    std::size_t codes;
    std::size_t exponents;
    std::size_t end;

    constexpr LightGroupsLayout(std::size_t probe_count, std::size_t groups)
        : probes(probe_count),
          codes(header_bytes + groups * name_bytes),
          exponents(codes + groups * probe_count * light_codes_bytes),
          end(exponents + groups * probe_count) {}

    [[nodiscard]] static constexpr std::size_t name_at(std::size_t g) {
        return header_bytes + g * name_bytes;
    }
    [[nodiscard]] constexpr std::size_t codes_at(std::size_t g, std::size_t p) const {
        return codes + (g * probes + p) * light_codes_bytes;
    }
    [[nodiscard]] constexpr std::size_t exponent_at(std::size_t g, std::size_t p) const {
        return exponents + g * probes + p;
    }
};

// Quality: header, one entry a probe, all groups' errors.
struct QualityLayout {
    static constexpr std::size_t buried_cells = 0;
    static constexpr std::size_t blind_cells = 4;
    static constexpr std::size_t group_count = 8;
    static constexpr std::size_t reserved = 10;
    static constexpr std::size_t header_bytes = 16;
    static constexpr std::size_t probe_bytes = 24;
    static constexpr std::size_t error_bytes = 4;
    // Within a probe's entry; its errors stand at its start.
    static constexpr std::size_t transfer_error = 0;
    static constexpr std::size_t visibility_error = 4;
    static constexpr std::size_t static_error = 8;
    static constexpr std::size_t error_count = 3;
    static constexpr std::size_t paths = 12;
    static constexpr std::size_t back_hits = 16;
    static constexpr std::size_t flags = 20;
    static constexpr std::size_t probe_reserved = 21;
    static constexpr std::uint8_t budget_ended_bit = 1;
    static constexpr std::uint8_t dark_bit = 2;
    static constexpr std::uint8_t moved_bit = 4;

    std::size_t probes;
    std::size_t group_errors;
    std::size_t end;

    constexpr QualityLayout(std::size_t probe_count, std::size_t groups)
        : probes(probe_count),
          group_errors(header_bytes + probe_count * probe_bytes),
          end(group_errors + groups * probe_count * error_bytes) {}

    [[nodiscard]] static constexpr std::size_t probe_at(std::size_t p) {
        return header_bytes + p * probe_bytes;
    }
    [[nodiscard]] constexpr std::size_t group_error_at(std::size_t g, std::size_t p) const {
        return group_errors + (g * probes + p) * error_bytes;
    }
};

// Where the values of a section lie in the file. Inside a compressed section no byte stands for one value:
// the section's first byte has to do.
struct Place {
    std::uint64_t start = 0;
    bool raw = true;

    [[nodiscard]] constexpr std::uint64_t at(std::uint64_t n) const { return raw ? start + n : start; }
};

}  // namespace drtv::layout
