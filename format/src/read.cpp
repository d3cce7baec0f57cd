// The sections that a sector file must have, and the sector they make.
#include <drtv/read.h>

#include "bytes.h"
#include "decode_section.h"
#include "layout.h"
#include "read_light.h"

#include <cmath>
#include <cstdlib>
#include <cstring>

namespace drtv {
namespace {

using Bytes = std::span<const std::uint8_t>;

// A section that must be there.
ReadStatus decode_required(Bytes file, std::span<const SectionEntry> entries, SectionKind kind, std::size_t raw_bytes, DecodedSection& out) {
    const SectionEntry* entry = find_section(entries, kind);
    if (entry == nullptr) {
        return fail(ReadError::missing_section, 0,
                    "the " + std::string(name_of_section(static_cast<std::uint16_t>(kind))) + " section is missing");
    }
    if (entry->version != 1) {
        return fail(ReadError::unsupported_version, entry->offset,
                    section_name(*entry) + " has version " + std::to_string(entry->version) + ", this reader knows 1");
    }
    return decode_section(file, *entry, raw_bytes, out);
}

ReadStatus read_bake(Bytes raw, const layout::Place& place, BakeRecord& bake) {
    bake.rays = load_le<std::uint32_t>(raw, 0);
    bake.bounces = load_le<std::uint32_t>(raw, 4);
    bake.reach_m = load_f32(raw, 8);
    bake.min_distance_m = load_f32(raw, 12);
    std::memcpy(bake.settings_key.data(), raw.data() + 16, bake.settings_key.size());
    if (!std::isfinite(bake.reach_m)) return fail(ReadError::bad_section, place.at(8), "bake section: the reach is not finite");
    if (!std::isfinite(bake.min_distance_m)) {
        return fail(ReadError::bad_section, place.at(12), "bake section: the minimal distance is not finite");
    }
    return {};
}

ReadStatus read_positions(Bytes raw, const layout::Place& place, std::vector<Probe>& probes) {
    for (std::size_t p = 0; p < probes.size(); ++p) {
        const std::size_t at = p * layout::position_bytes;
        for (std::size_t axis = 0; axis < 3; ++axis) probes[p].position[axis] = load_le<std::uint16_t>(raw, at + 2 * axis);
        if (raw[at + 6] > static_cast<std::uint8_t>(ProbeKind::manual)) {
            return fail(ReadError::bad_section, place.at(at + 6), "probe " + std::to_string(p) + ": kind " + std::to_string(raw[at + 6]) + " is unknown");
        }
        if (raw[at + 7] != 0) {
            return fail(ReadError::bad_section, place.at(at + 7), "probe " + std::to_string(p) + ": its reserved byte is not zero");
        }
        probes[p].kind = static_cast<ProbeKind>(raw[at + 6]);
    }
    return {};
}

void read_sky_visibility(Bytes raw, std::vector<Probe>& probes) {
    std::size_t at = 0;
    for (Probe& probe : probes) at = load_codes(raw, at, probe.sky_visibility);
}

void read_transfer(Bytes raw, std::vector<Probe>& probes) {
    std::size_t at = 0;
    for (Probe& probe : probes) at = load_codes(raw, at, probe.transfer);
}

ReadStatus read_grid(Bytes raw, const layout::Place& place, Grid& grid) {
    grid.z_origin_units = load_i32(raw, 0);
    grid.cell_height_units = load_le<std::uint32_t>(raw, 4);
    if (std::abs(std::int64_t{grid.z_origin_units}) > max_z_origin_units) {
        return fail(ReadError::bad_section, place.at(0), "grid section: z origin " + std::to_string(grid.z_origin_units) + " is over the limit of 2^30");
    }
    if (grid.cell_height_units == 0 || grid.cell_height_units > max_cell_height_units) {
        return fail(ReadError::bad_section, place.at(4), "grid section: the cell height " + std::to_string(grid.cell_height_units) + " is not between 1 and 2^24");
    }
    if (load_le<std::uint64_t>(raw, 8) != 0) return fail(ReadError::bad_section, place.at(8), "grid section: reserved bytes are not zero");
    std::memcpy(grid.cells.data(), raw.data() + layout::grid_header_bytes, grid.cells.size());
    return {};
}

ReadStatus read_statistics(Bytes raw, const layout::Place& place, Statistics& s) {
    s.candidates = load_le<std::uint32_t>(raw, 0);
    s.moved_out = load_le<std::uint32_t>(raw, 4);
    s.dropped_in_solid = load_le<std::uint32_t>(raw, 8);
    s.removed_by_volume = load_le<std::uint32_t>(raw, 12);
    s.thinned = load_le<std::uint32_t>(raw, 16);
    s.used_distance_m = load_f32(raw, 20);
    s.rays = load_le<std::uint64_t>(raw, 24);
    s.back_hits = load_le<std::uint64_t>(raw, 32);
    if (!std::isfinite(s.used_distance_m)) return fail(ReadError::bad_section, place.at(20), "statistics section: the used distance is not finite");
    return {};
}

}  // namespace

ReadStatus read_sector(std::span<const std::uint8_t> bytes, Sector& sector) {
    namespace h = layout::header;
    std::vector<SectionEntry> entries;
    if (ReadStatus status = read_section_table(bytes, entries); !status.ok()) return status;

    Sector s;
    s.i = load_i32(bytes, h::sector_i);
    s.j = load_i32(bytes, h::sector_j);
    s.z_origin_units = load_i32(bytes, h::z_origin);
    s.z_shift = bytes[h::z_shift];
    s.probes.resize(load_le<std::uint16_t>(bytes, h::probe_count));
    const std::size_t count = s.probes.size();

    DecodedSection section;
    const std::vector<std::uint8_t>& raw = section.raw;
    const layout::Place& place = section.place;
    const auto decode = [&](SectionKind kind, std::size_t size) { return decode_required(bytes, entries, kind, size, section); };

    if (ReadStatus status = decode(SectionKind::bake, layout::bake_bytes); !status.ok()) return status;
    if (ReadStatus status = read_bake(raw, place, s.bake); !status.ok()) return status;
    if (ReadStatus status = decode(SectionKind::positions, count * layout::position_bytes); !status.ok()) return status;
    if (ReadStatus status = read_positions(raw, place, s.probes); !status.ok()) return status;
    if (ReadStatus status = decode(SectionKind::sky_visibility, count * layout::sky_visibility_bytes); !status.ok()) return status;
    read_sky_visibility(raw, s.probes);
    if (ReadStatus status = decode(SectionKind::transfer, count * layout::transfer_bytes); !status.ok()) return status;
    read_transfer(raw, s.probes);
    if (ReadStatus status = decode(SectionKind::grid, layout::grid_bytes); !status.ok()) return status;
    if (ReadStatus status = read_grid(raw, place, s.grid); !status.ok()) return status;
    if (ReadStatus status = decode(SectionKind::statistics, layout::statistics_bytes); !status.ok()) return status;
    if (ReadStatus status = read_statistics(raw, place, s.statistics); !status.ok()) return status;
    if (ReadStatus status = read_light_sections(bytes, entries, s); !status.ok()) return status;
    sector = std::move(s);
    return {};
}

}  // namespace drtv
