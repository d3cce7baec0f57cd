// Uses a raw sector file in place, mapped or loaded, without a copy. For games; drtv/sector_set.h has sets of
// sectors.
//
// Pure functions, thread-safe; only error messages allocate. Opening checks every byte once: some 2 us for a
// file of 14 KB. Later calls cost nanoseconds, except those on interiors, which look at each triangle.
//
//     drtv::SectorView sector;
//     if (drtv::open_sector(mapped_bytes, sector).ok()) {
//         const std::uint8_t p = drtv::find_probe(sector, {x, y, z});
//         if (p != drtv::no_probe) use(sector.transfer[p]);
//     }
#pragma once

#include <drtv/read.h>
#include <drtv/sector.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace drtv {

static_assert(std::endian::native == std::endian::little,
              "the file's integers are little-endian and used as they lie");

// The structures in the file, byte for byte (SPEC.md, section 5).
struct StoredPosition {
    std::array<std::uint16_t, 3> position;
    ProbeKind kind;
    std::uint8_t reserved;
};
struct StoredGrid {
    std::int32_t z_origin_units;
    std::uint32_t cell_height_units;
    std::uint64_t reserved;
    std::array<std::uint8_t, grid_cell_count> cells;
};
struct StoredReceiver {
    std::uint32_t first_pair;
    std::int8_t exponent;
    std::array<std::uint8_t, 3> reserved;
};
struct StoredInterior {
    std::array<std::int32_t, 3> origin_units;
    std::uint8_t shift, probe;
    std::array<std::uint8_t, 2> reserved;
    std::uint32_t first_vertex, vertex_count, first_triangle, triangle_count;
};
using StoredName = std::array<char, max_light_group_name + 1>;  // filled up with zeros
static_assert(sizeof(StoredPosition) == 8 && sizeof(StoredGrid) == 4112 && sizeof(StoredReceiver) == 8 &&
              sizeof(StoredInterior) == 32);

// Points into the file's bytes, which must outlive it. Probe p of one span is probe p of every other. Spans
// of optional sections are empty where the file has none.
struct SectorView {
    std::int32_t i = 0, j = 0;
    std::int32_t z_origin_units = 0;
    std::uint8_t z_shift = 0;
    std::size_t probe_count = 0;

    std::span<const StoredPosition> positions;
    std::span<const VisibilityCodes> sky_visibility;
    std::span<const TransferCodes> transfer;
    const StoredGrid* grid = nullptr;
    std::span<const LightCodes> static_irradiance;  // [c][b], scale 2^exponent
    std::span<const std::int8_t> static_exponents;
    std::span<const LocalSource> local_sources;
    std::span<const StoredReceiver> local_receivers;
    std::span<const std::uint8_t> local_masks;  // local_mask_bytes per receiver
    std::size_t local_mask_bytes = 0;
    std::span<const LightCodes> local_pairs;  // [c][i], scale 2^(receiver's + source's exponent)
    std::span<const StoredInterior> interiors;
    std::span<const std::array<std::uint16_t, 3>> interior_vertices;  // of all interiors
    std::span<const std::array<std::uint16_t, 3>>
        interior_triangles;  // indices within their interior's vertices
    std::span<const StoredName> light_group_names;
    std::span<const LightCodes> light_group_irradiance;  // group by group, one per probe: [c][b]
    std::span<const std::int8_t> light_group_exponents;  // likewise
};

// Opens the sector in `bytes`. Checks all that read_sector checks; untrusted bytes are safe. Allocates
// nothing but the message of an error. A file with a compressed section fails with `compressed`: see
// unpack_sector. On error `view` is left as it was. REQUIRES for success: `bytes` starts at a multiple of 16
// (a mapped file does), else `misaligned`.
ReadStatus open_sector(std::span<const std::uint8_t> bytes, SectorView& view);

// Makes the same file with every section raw. Sections that this reader does not know are dropped. On error
// `raw_file` is left as it was. (The allocators of 64-bit systems start a vector's bytes at a multiple of 16,
// so that open_sector takes them.)
ReadStatus unpack_sector(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& raw_file);

// World position of a probe in metres; exact in float within 16 km of the origin. REQUIRES: p <
// sector.probe_count.
[[nodiscard]] Float3 position_m(const SectorView& sector, std::size_t p);
// The same in double: exact everywhere.
[[nodiscard]] Double3 exact_position_m(const SectorView& sector, std::size_t p);

// The probe that the grid names for a world position (SPEC.md, section 5.5); `no_probe` where the cell has
// none: then the open sky takes its place. The probe lights what is outside of all interiors (ask
// find_interior first), unless it is an interior's own (section 5.11). A position beside, above or below the
// grid takes the nearest cell.
[[nodiscard]] std::uint8_t find_probe(const SectorView& sector, const Double3& world_m);

// REQUIRES: the sector has static irradiance, p < sector.probe_count.
[[nodiscard]] StaticIrradiance static_irradiance_of(const SectorView& sector, std::size_t p);

// The index of the light group of that name in this sector; each sector has its own order. Empty where the
// sector does not have the group, which then brings no light to its probes.
[[nodiscard]] std::optional<std::size_t> find_light_group(const SectorView& sector, std::string_view name);

// The group's name, by its index; it points into the file's bytes. REQUIRES: g <
// sector.light_group_names.size().
[[nodiscard]] std::string_view light_group_name(const SectorView& sector, std::size_t g);

// What the group brings to a probe. REQUIRES: g < sector.light_group_names.size(), p < sector.probe_count.
[[nodiscard]] StaticIrradiance light_group_irradiance_of(const SectorView& sector,
                                                         std::size_t g,
                                                         std::size_t p);

// What a light at source `s` (an index into local_sources) sends to probe `p` by bounce. `codes` is null
// where the two are not a pair: then the light adds nothing. REQUIRES: the sector has local transfer, p <
// sector.probe_count, s < sector.local_sources.size().
struct LocalPair {
    const LightCodes* codes = nullptr;
    float scale = 0;
};
[[nodiscard]] LocalPair find_local_pair(const SectorView& sector, std::size_t p, std::size_t s);

// Whether a world position is inside the closed mesh, by its winding number, so that triangles without an
// area do no harm. On the mesh itself the answer may be either.
[[nodiscard]] bool is_inside(const SectorView& sector,
                             const StoredInterior& interior,
                             const Double3& world_m);

// Bounds in the world, in metres. Those of an interior without vertices hold nothing.
struct InteriorBounds {
    Double3 low{};
    Double3 high{};
};
[[nodiscard]] InteriorBounds bounds_of(const SectorView& sector, const StoredInterior& interior);

// Distance in metres from a world position to the closed mesh: above 0 inside, below 0 outside. Looks at
// every triangle. Minus infinity for an interior without triangles.
[[nodiscard]] double signed_distance_m(const SectorView& sector,
                                       const StoredInterior& interior,
                                       const Double3& world_m);

// The first interior that holds a world position; null where none does.
[[nodiscard]] const StoredInterior* find_interior(const SectorView& sector, const Double3& world_m);

}  // namespace drtv
