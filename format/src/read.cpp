#include <drtv/read.h>

#include "bytes.h"
#include "checksum.h"
#include "layout.h"

#include <zstd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace drtv {
namespace {

using Bytes = std::span<const std::uint8_t>;

std::string text(std::uint64_t value) { return std::to_string(value); }

ReadStatus fail(ReadError error, std::uint64_t offset, std::string message) {
    return {error, offset, std::move(message)};
}

bool all_zero(Bytes bytes) {
    for (std::uint8_t b : bytes) {
        if (b != 0) return false;
    }
    return true;
}

std::string section_name(const SectionEntry& entry) {
    return std::string(name_of_section(entry.kind)) + " section (kind " + text(entry.kind) + ")";
}

SectionEntry load_entry(Bytes file, std::size_t at) {
    namespace e = layout::entry;
    return {load_le<std::uint16_t>(file, at + e::kind),      load_le<std::uint16_t>(file, at + e::version),
            file[at + e::codec],                              load_le<std::uint32_t>(file, at + e::offset),
            load_le<std::uint32_t>(file, at + e::stored_bytes), load_le<std::uint32_t>(file, at + e::raw_bytes),
            load_le<std::uint64_t>(file, at + e::checksum)};
}

ReadStatus check_header(Bytes file, std::size_t& section_count) {
    namespace h = layout::header;
    if (file.size() < 4 || load_le<std::uint32_t>(file, h::magic) != layout::magic) {
        return fail(ReadError::not_a_sector_file, 0, "not a drtv sector file: it does not start with \"DRTV\"");
    }
    // Magic and version come first and stay so in every version, whatever the length of its header.
    if (file.size() >= h::file_bytes && load_le<std::uint16_t>(file, h::major) != layout::major_version) {
        return fail(ReadError::unsupported_version, h::major,
                    "format version " + text(load_le<std::uint16_t>(file, h::major)) + "." +
                        text(load_le<std::uint16_t>(file, h::minor)) + " is not supported: this reader knows version 1");
    }
    if (file.size() < layout::header_bytes) {
        return fail(ReadError::truncated, file.size(), "the header needs 64 bytes, the file has " + text(file.size()));
    }
    const auto file_bytes = load_le<std::uint32_t>(file, h::file_bytes);
    if (file.size() < file_bytes) {
        return fail(ReadError::truncated, file.size(),
                    "the header says " + text(file_bytes) + " bytes, the file has " + text(file.size()));
    }
    if (file.size() > file_bytes) {
        return fail(ReadError::trailing_bytes, file_bytes,
                    "the header says " + text(file_bytes) + " bytes, the file has " + text(file.size()));
    }
    section_count = load_le<std::uint32_t>(file, h::section_count);
    if (section_count > layout::max_sections ||
        layout::header_bytes + section_count * layout::entry_bytes > file.size()) {
        return fail(ReadError::bad_header, h::section_count,
                    "the header says " + text(section_count) + " sections, which do not fit the file or the limit of 64");
    }
    std::vector<std::uint8_t> covered(file.begin(), file.begin() + h::checksum);
    const Bytes table = file.subspan(layout::header_bytes, section_count * layout::entry_bytes);
    covered.insert(covered.end(), table.begin(), table.end());
    if (xxh64(covered) != load_le<std::uint64_t>(file, h::checksum)) {
        return fail(ReadError::checksum_mismatch, h::checksum, "the header's checksum does not match header and table");
    }
    const auto i = load_i32(file, h::sector_i), j = load_i32(file, h::sector_j);
    if (std::abs(std::int64_t{i}) > max_sector_coordinate || std::abs(std::int64_t{j}) > max_sector_coordinate) {
        return fail(ReadError::bad_header, std::abs(std::int64_t{i}) > max_sector_coordinate ? h::sector_i : h::sector_j,
                    "sector (" + std::to_string(i) + ", " + std::to_string(j) + ") is beyond the limit of 16384");
    }
    const auto probe_count = load_le<std::uint16_t>(file, h::probe_count);
    if (probe_count > max_probes) {
        return fail(ReadError::bad_header, h::probe_count, "probe count " + text(probe_count) + " is over the limit of 255");
    }
    if (file[h::z_shift] > max_z_shift) {
        return fail(ReadError::bad_header, h::z_shift, "z shift " + text(file[h::z_shift]) + " is over the limit of 10");
    }
    if (std::abs(std::int64_t{load_i32(file, h::z_origin)}) > max_z_origin_units) {
        return fail(ReadError::bad_header, h::z_origin, "z origin " + std::to_string(load_i32(file, h::z_origin)) + " is over the limit of 2^30");
    }
    if (!all_zero(file.subspan(h::reserved, h::checksum - h::reserved))) {
        return fail(ReadError::bad_header, h::reserved, "reserved header bytes are not zero");
    }
    return {};
}

ReadStatus check_entry(Bytes file, std::size_t at, const SectionEntry& entry, std::size_t& end) {
    const std::string name = section_name(entry);
    if (!all_zero(file.subspan(at + layout::entry::reserved, 3)) ||
        load_le<std::uint32_t>(file, at + layout::entry::reserved2) != 0) {
        return fail(ReadError::bad_table, at, name + ": reserved bytes of its entry are not zero");
    }
    if (entry.offset != layout::align(end)) {
        return fail(ReadError::bad_table, at, name + " starts at " + text(entry.offset) + ", must start at " + text(layout::align(end)));
    }
    if (entry.stored_bytes > file.size() || entry.offset > file.size() - entry.stored_bytes) {
        return fail(ReadError::bad_table, at,
                    name + " ends at " + text(std::uint64_t{entry.offset} + entry.stored_bytes) + ", the file has " +
                        text(file.size()) + " bytes");
    }
    if (entry.raw_bytes > layout::max_raw_section_bytes) {
        return fail(ReadError::bad_table, at, name + " decodes to " + text(entry.raw_bytes) + " bytes, over the limit of 16 MiB");
    }
    if (entry.codec == static_cast<std::uint8_t>(Codec::raw) && entry.raw_bytes != entry.stored_bytes) {
        return fail(ReadError::bad_table, at,
                    name + " is raw but says " + text(entry.stored_bytes) + " stored and " + text(entry.raw_bytes) + " raw bytes");
    }
    if (!all_zero(file.subspan(end, entry.offset - end))) {
        return fail(ReadError::bad_table, end, name + ": the padding before it is not zero");
    }
    if (xxh64(file.subspan(entry.offset, entry.stored_bytes)) != entry.checksum) {
        return fail(ReadError::checksum_mismatch, entry.offset, name + ": its checksum does not match its bytes");
    }
    end = std::size_t{entry.offset} + entry.stored_bytes;
    return {};
}

// One Zstandard frame, whole and alone: no skippable frame, none of a format before 0.8, nothing behind it.
bool is_one_frame(Bytes stored) {
    return stored.size() >= 4 && load_le<std::uint32_t>(stored, 0) == ZSTD_MAGICNUMBER &&
           ZSTD_findFrameCompressedSize(stored.data(), stored.size()) == stored.size();
}

// The decoded bytes of one section, with the size its kind demands.
ReadStatus decode_section(Bytes file, const std::vector<SectionEntry>& entries, SectionKind kind, std::size_t raw_bytes,
                          std::vector<std::uint8_t>& out, layout::Place& place) {
    for (const SectionEntry& entry : entries) {
        if (entry.kind != static_cast<std::uint16_t>(kind)) continue;
        place = {entry.offset, entry.codec == static_cast<std::uint8_t>(Codec::raw)};
        const std::uint64_t offset = entry.offset;
        const std::string name = section_name(entry);
        if (entry.version != 1) {
            return fail(ReadError::unsupported_version, offset, name + " has version " + text(entry.version) + ", this reader knows 1");
        }
        if (entry.raw_bytes != raw_bytes) {
            return fail(ReadError::bad_section, offset, name + " has " + text(entry.raw_bytes) + " bytes, must have " + text(raw_bytes));
        }
        const Bytes stored = file.subspan(entry.offset, entry.stored_bytes);
        if (entry.codec == static_cast<std::uint8_t>(Codec::raw)) {
            out.assign(stored.begin(), stored.end());
            return {};
        }
        if (entry.codec != static_cast<std::uint8_t>(Codec::zstd)) {
            return fail(ReadError::bad_section, offset, name + " has the unknown codec " + text(entry.codec));
        }
        if (!is_one_frame(stored)) {
            return fail(ReadError::bad_section, offset, name + ": its " + text(stored.size()) + " bytes are not one whole zstd frame");
        }
        out.assign(raw_bytes, 0);
        const std::size_t size = ZSTD_decompress(out.data(), out.size(), stored.data(), stored.size());
        if (ZSTD_isError(size) || size != raw_bytes) {
            return fail(ReadError::bad_section, offset, name + ": its zstd frame does not decode to " + text(raw_bytes) + " bytes");
        }
        return {};
    }
    return fail(ReadError::missing_section, 0,
                "the " + std::string(name_of_section(static_cast<std::uint16_t>(kind))) + " section is missing");
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
            return fail(ReadError::bad_section, place.at(at + 6), "probe " + text(p) + ": kind " + text(raw[at + 6]) + " is unknown");
        }
        if (raw[at + 7] != 0) {
            return fail(ReadError::bad_section, place.at(at + 7), "probe " + text(p) + ": its reserved byte is not zero");
        }
        probes[p].kind = static_cast<ProbeKind>(raw[at + 6]);
    }
    return {};
}

void read_sky_visibility(Bytes raw, std::vector<Probe>& probes) {
    std::size_t at = 0;
    for (Probe& probe : probes) {
        for (std::int16_t& q : probe.sky_visibility) {
            q = load_i16(raw, at);
            at += 2;
        }
    }
}

void read_transfer(Bytes raw, std::vector<Probe>& probes) {
    std::size_t at = 0;
    for (Probe& probe : probes) {
        for (auto& channel : probe.transfer) {
            for (auto& row : channel) {
                for (std::int16_t& q : row) {
                    q = load_i16(raw, at);
                    at += 2;
                }
            }
        }
    }
}

ReadStatus read_grid(Bytes raw, const layout::Place& place, Grid& grid) {
    grid.z_origin_units = load_i32(raw, 0);
    grid.cell_height_units = load_le<std::uint32_t>(raw, 4);
    if (std::abs(std::int64_t{grid.z_origin_units}) > max_z_origin_units) {
        return fail(ReadError::bad_section, place.at(0), "grid section: z origin " + std::to_string(grid.z_origin_units) + " is over the limit of 2^30");
    }
    if (grid.cell_height_units == 0 || grid.cell_height_units > max_cell_height_units) {
        return fail(ReadError::bad_section, place.at(4), "grid section: the cell height " + text(grid.cell_height_units) + " is not between 1 and 2^24");
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

std::string_view name_of_section(std::uint16_t kind) {
    switch (static_cast<SectionKind>(kind)) {
        case SectionKind::bake: return "bake";
        case SectionKind::positions: return "positions";
        case SectionKind::sky_visibility: return "sky visibility";
        case SectionKind::transfer: return "transfer";
        case SectionKind::grid: return "grid";
        case SectionKind::statistics: return "statistics";
    }
    return "unknown";
}

ReadStatus read_section_table(std::span<const std::uint8_t> bytes, std::vector<SectionEntry>& entries) {
    entries.clear();
    std::size_t section_count = 0;
    if (ReadStatus status = check_header(bytes, section_count); !status.ok()) return status;
    std::vector<SectionEntry> found;
    std::size_t end = layout::header_bytes + section_count * layout::entry_bytes;
    for (std::size_t n = 0; n < section_count; ++n) {
        const std::size_t at = layout::header_bytes + n * layout::entry_bytes;
        const SectionEntry entry = load_entry(bytes, at);
        if (ReadStatus status = check_entry(bytes, at, entry, end); !status.ok()) return status;
        for (const SectionEntry& earlier : found) {
            if (earlier.kind == entry.kind) return fail(ReadError::bad_table, at, section_name(entry) + " stands twice in the table");
        }
        found.push_back(entry);
    }
    if (end != bytes.size()) {
        return fail(ReadError::bad_table, end, "the last section ends at " + text(end) + ", the file has " + text(bytes.size()) + " bytes");
    }
    entries = std::move(found);
    return {};
}

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

    std::vector<std::uint8_t> raw;
    layout::Place place;
    const auto decode = [&](SectionKind kind, std::size_t size) { return decode_section(bytes, entries, kind, size, raw, place); };

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
    sector = std::move(s);
    return {};
}

}  // namespace drtv
