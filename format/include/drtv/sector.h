// A sector in memory: the numbers of one sector file, still in their stored fixed-point form, so that reading
// and writing lose nothing. Layout, units and rules: SPEC.md. Plain structs for tools; games use drtv/view.h.
//
//     for (const drtv::Probe& probe : sector.probes) {
//         const drtv::Float3 at = drtv::position_m(sector, probe);
//         const float up = drtv::decode_fixed(probe.sky_visibility[2], drtv::sky_visibility_scale);
//     }
#pragma once

#include <drtv/conventions.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drtv {

enum class ProbeKind : std::uint8_t { ground = 0, vegetation = 1, manual = 2 };

// "ground", "vegetation" or "manual".
[[nodiscard]] std::string_view name_of(ProbeKind kind);

// [channel r, g, b][basis direction][SH coefficient], scale 0.5: E/pi from a sky of radiance Y_i, by bounce.
using TransferCodes = std::array<std::array<std::array<std::int16_t, sh_count>, basis_count>, channel_count>;
// [basis direction], scale 1: open sky = 1; the last one is always 0 (slide 21 of the talk).
using VisibilityCodes = std::array<std::int16_t, basis_count>;

struct Probe {
    // Offset from the sector's corner in units of 2^-10 m (x, y) and 2^(shift - 10) m (z).
    std::array<std::uint16_t, 3> position{};
    ProbeKind kind = ProbeKind::ground;
    TransferCodes transfer{};
    VisibilityCodes sky_visibility{};

    bool operator==(const Probe&) const = default;
};

// One probe per cell, if possible one that the cell sees. Cell (x, y, z) has the index x + 16 y + 256 z;
// cells are 4 m wide. The reader accepts any value: one that is not below the number of probes counts as
// `no_probe` (SPEC.md, section 5.5).
struct Grid {
    std::int32_t z_origin_units = 0;      // bottom of the lowest cells, 2^-10 m
    std::uint32_t cell_height_units = 1;  // 2^-10 m, 1 to 2^24
    std::array<std::uint8_t, grid_cell_count> cells{};

    bool operator==(const Grid&) const = default;
};

// What was asked of the baker, and which baker it was. Files with the same settings_key are comparable.
struct BakeRecord {
    std::uint32_t rays = 0;     // primary rays per probe
    std::uint32_t bounces = 0;  // surface bounces
    float reach_m = 0;          // what is farther from the probe is sky
    float min_distance_m = 0;   // between automatic probes
    std::array<std::uint8_t, 32>
        settings_key{};  // SHA-256 over settings, format version, baker and ISA class
    bool operator==(const BakeRecord&) const = default;
};

// Counts of the bake: a pure function of the map, like all else in the file (no times).
struct Statistics {
    std::uint32_t candidates = 0;         // proposed places inside the sector
    std::uint32_t moved_out = 0;          // probes moved out of a solid
    std::uint32_t dropped_in_solid = 0;   // probes for which no free place was found
    std::uint32_t removed_by_volume = 0;  // inside a no_probes volume
    std::uint32_t thinned = 0;            // probes given up to stay within 255
    float used_distance_m = 0;            // minimal distance in the end; min_distance_m unless thinned
    std::uint64_t rays = 0;               // all rays of the integration
    std::uint64_t back_hits = 0;          // rays that hit the back of a one-sided surface

    bool operator==(const Statistics&) const = default;
};

// [channel r, g, b][basis direction or SH coefficient], fixed point; the scale is stored beside it as an
// exponent.
using LightCodes = std::array<std::array<std::int16_t, 4>, channel_count>;

// E/pi around each basis direction from the map's own lights, direct and bounced: codes[c][b], scale
// 2^exponent.
struct StaticIrradiance {
    LightCodes codes{};
    std::int8_t exponent = 0;

    bool operator==(const StaticIrradiance&) const = default;
};

// A probe at whose place a local light may stand: probe `probe` of the sector (i + di, j + dj), di and dj in
// -1..1.
struct LocalSource {
    std::int8_t di = 0, dj = 0;
    std::uint8_t probe = 0;
    std::int8_t exponent = 0;  // its part of the scale of its pairs

    bool operator==(const LocalSource&) const = default;
};

// One probe's row of the sparse matrix receiver x source: which pairs it has and the index of its first one.
struct LocalReceiver {
    std::uint32_t first_pair = 0;
    std::int8_t exponent = 0;  // its part of the scale of its pairs
    // Bit s & 7 of byte s >> 3 is 1 where source s has a pair. At most local_mask_bytes; missing bytes count
    // as 0.
    std::vector<std::uint8_t> sources;

    bool operator==(const LocalReceiver&) const = default;
};

// Bytes of a receiver's mask for that many sources: a multiple of 16, at least 16.
[[nodiscard]] constexpr std::size_t local_mask_bytes(std::size_t sources) {
    constexpr std::size_t step = 128;  // sources per 16 bytes
    return sources <= step ? step / 8 : (sources + step - 1) / step * (step / 8);
}

// Whether the receiver has a pair with source `s` of its sector.
[[nodiscard]] inline bool has_pair(const LocalReceiver& receiver, std::size_t s) {
    return s >> 3 < receiver.sources.size() && (receiver.sources[s >> 3] >> (s & 7) & 1) != 0;
}

// Light that a local light at a source's place sends to a receiver by bounce (SPEC.md, section 5.8). Pair n
// of receiver p and source s: R_c[i] = 2^(receiver exponent + source exponent) * code / 32767.
struct LocalTransfer {
    std::vector<LocalSource> sources;      // at most max_sector_sources
    std::vector<LocalReceiver> receivers;  // one per probe
    std::vector<LightCodes> pairs;         // [c][i]; by receiver, then by source

    bool operator==(const LocalTransfer&) const = default;
};

// What was asked of the bake and what it reached, for bakes that measured it.
struct Convergence {
    // Relative standard error of E/pi relit by a sky of radiance 1 (SPEC.md, section 5.9).
    float error_asked = 0;                                 // 0: a fixed number of paths
    float error_median = 0, error_p95 = 0, error_max = 0;  // over the sector's probes
    std::uint32_t paths_least = 0, paths_most = 0;         // per probe
    std::uint32_t local_bounces = 0;                       // 0 where the file has no local transfer
    std::uint32_t local_rays = 0;                          // traced from each source; 0 as above
    std::uint64_t static_rays = 0;                         // for static irradiance, shadow rays included
    std::uint64_t local_transfer_rays = 0;

    bool operator==(const Convergence&) const = default;
};

// A closed mesh; what is inside uses one probe (slide 56 of the talk). Vertex v stands at the world position
// origin_units + vertices[v] * 2^shift, in units of 2^-10 m.
struct Interior {
    std::array<std::int32_t, 3> origin_units{};
    std::uint8_t shift = 0;  // at most max_interior_shift
    std::uint8_t probe = 0;  // of this sector
    std::vector<std::array<std::uint16_t, 3>> vertices;
    std::vector<std::array<std::uint16_t, 3>>
        triangles;  // indices of vertices, counter-clockwise seen from outside

    bool operator==(const Interior&) const = default;
};

// Static irradiance of the lights that a game switches and colours together, one per probe. Their light is in
// no other group and not in Sector::static_irradiance.
struct LightGroup {
    std::string name;  // UTF-8, 1 to max_light_group_name bytes
    std::vector<StaticIrradiance> irradiance;

    bool operator==(const LightGroup&) const = default;
};

// How exact a probe's light is (SPEC.md, section 5.13). Each error is a standard error divided by the mean of
// the same numbers.
struct ProbeQuality {
    float transfer_error = 0;  // of the bounce, relit by a sky of radiance 1
    float visibility_error = 0;
    float static_error = 0;  // of the light that is in no group
    std::uint32_t paths = 0;
    std::uint32_t back_hits = 0;  // rays that ended at the back of a one-sided surface
    bool budget_ended = false;    // paths were used up before the error that was asked for was reached
    bool dark = false;            // no light of sky or map reaches it
    bool moved = false;           // out of a solid

    bool operator==(const ProbeQuality&) const = default;
};

struct Quality {
    std::uint32_t buried_cells = 0;                // of the grid: in solids or under the ground
    std::uint32_t blind_cells = 0;                 // other cells, which see no probe that they may name
    std::vector<ProbeQuality> probes;              // one per probe
    std::vector<std::vector<float>> group_errors;  // [light group][probe], of the groups in the bake

    bool operator==(const Quality&) const = default;
};

struct Sector {
    std::int32_t i = 0, j = 0;        // world square [64 i, 64 i + 64) x [64 j, 64 j + 64)
    std::int32_t z_origin_units = 0;  // height of position z = 0, 2^-10 m
    std::uint8_t z_shift = 0;         // z step is 2^(z_shift - 10) m
    std::vector<Probe> probes;        // at most 255
    Grid grid;
    BakeRecord bake;
    Statistics statistics;
    // Since format 1.1, each optional:
    std::vector<StaticIrradiance> static_irradiance;  // empty or one per probe
    std::optional<LocalTransfer> local_transfer;
    std::optional<Convergence> convergence;
    // Since format 1.2, optional:
    std::vector<Interior> interiors;  // at most max_interiors
    // Since format 1.3, each optional:
    std::vector<LightGroup> light_groups;  // at most max_light_groups, sorted by name
    std::optional<Quality> quality;

    bool operator==(const Sector&) const = default;
};

// Sector coordinates beyond +-max_sector_coordinate are refused, so that every position in units fits 32
// bits.
inline constexpr std::int32_t max_sector_coordinate = 1 << 14;
inline constexpr std::uint8_t max_z_shift = 10;
inline constexpr std::int32_t max_z_origin_units = 1 << 30;       // of the sector and of the grid
inline constexpr std::uint32_t max_cell_height_units = 1u << 24;  // so that 16 cells fit 32 bits too
inline constexpr std::size_t max_light_groups = 8;
inline constexpr std::size_t max_light_group_name = 63;  // bytes
inline constexpr std::size_t max_interiors = 1024;
inline constexpr std::size_t max_interior_vertices = 1u << 16;  // of one interior
inline constexpr std::size_t max_interiors_vertices = 1u
                                                      << 21;  // of all together, so that they fit a section
inline constexpr std::size_t max_interior_triangles = 1u << 18;  // of all together
inline constexpr std::uint8_t max_interior_shift = 10;
inline constexpr std::int32_t max_interior_origin_units =
    (1 << 30) + (1 << 27);  // 131 km beyond the farthest sector

// World position of a probe in units of 2^-10 m, exact.
[[nodiscard]] std::array<std::int32_t, 3> position_units(const Sector& sector, const Probe& probe);

// World position in metres; exact in float within 16 km of the origin.
[[nodiscard]] Float3 position_m(const Sector& sector, const Probe& probe);

}  // namespace drtv
