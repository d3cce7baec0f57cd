#include <drtv/write.h>

#include "bytes.h"
#include "checksum.h"
#include "layout.h"
#include "local_filter.h"

#include <zstd.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>

namespace drtv {
namespace {

using Bytes = std::vector<std::uint8_t>;

// High enough to be worth the time once, low enough to stay under a millisecond a sector. Local transfer is
// most of a file that has it: from level 15 on zstd gives each stretch of it its own statistics.
constexpr int zstd_level = 12, zstd_level_of_local_transfer = 15;

Bytes bake_section(const BakeRecord& bake) {
    Bytes bytes;
    append_le(bytes, bake.rays);
    append_le(bytes, bake.bounces);
    append_f32(bytes, bake.reach_m);
    append_f32(bytes, bake.min_distance_m);
    bytes.insert(bytes.end(), bake.settings_key.begin(), bake.settings_key.end());
    return bytes;
}

Bytes positions_section(const std::vector<Probe>& probes) {
    Bytes bytes;
    for (const Probe& probe : probes) {
        for (std::uint16_t axis : probe.position)
            append_le(bytes, axis);
        bytes.push_back(static_cast<std::uint8_t>(probe.kind));
        bytes.push_back(0);
    }
    return bytes;
}

Bytes sky_visibility_section(const std::vector<Probe>& probes) {
    Bytes bytes;
    for (const Probe& probe : probes)
        append_codes(bytes, probe.sky_visibility);
    return bytes;
}

Bytes transfer_section(const std::vector<Probe>& probes) {
    Bytes bytes;
    for (const Probe& probe : probes)
        append_codes(bytes, probe.transfer);
    return bytes;
}

Bytes grid_section(const Grid& grid) {
    Bytes bytes;
    append_le(bytes, static_cast<std::uint32_t>(grid.z_origin_units));
    append_le(bytes, grid.cell_height_units);
    append_le(bytes, std::uint64_t{0});
    bytes.insert(bytes.end(), grid.cells.begin(), grid.cells.end());
    return bytes;
}

Bytes statistics_section(const Statistics& s) {
    Bytes bytes;
    for (std::uint32_t n : {s.candidates, s.moved_out, s.dropped_in_solid, s.removed_by_volume, s.thinned})
        append_le(bytes, n);
    append_f32(bytes, s.used_distance_m);
    append_le(bytes, s.rays);
    append_le(bytes, s.back_hits);
    return bytes;
}

Bytes static_irradiance_section(const std::vector<StaticIrradiance>& probes) {
    Bytes bytes;
    for (const StaticIrradiance& probe : probes)
        append_codes(bytes, probe.codes);
    for (const StaticIrradiance& probe : probes)
        bytes.push_back(static_cast<std::uint8_t>(probe.exponent));
    return bytes;
}

Bytes local_transfer_section(const LocalTransfer& local) {
    const std::size_t mask_bytes = layout::LocalTransferLayout::mask_bytes(local.sources.size());
    const layout::LocalTransferLayout parts(local.receivers.size(), local.sources.size(), local.pairs.size());
    Bytes bytes;
    bytes.reserve(parts.end);
    append_le(bytes, static_cast<std::uint16_t>(local.sources.size()));
    append_le(bytes, static_cast<std::uint16_t>(mask_bytes));
    append_le(bytes, static_cast<std::uint32_t>(local.pairs.size()));
    append_le(bytes, std::uint64_t{0});
    for (const LocalSource& source : local.sources) {
        append_le(bytes, source.di);
        append_le(bytes, source.dj);
        append_le(bytes, source.probe);
        append_le(bytes, source.exponent);
    }
    bytes.resize(parts.receivers, 0);
    for (const LocalReceiver& receiver : local.receivers) {
        append_le(bytes, receiver.first_pair);
        append_le(bytes, receiver.exponent);
        bytes.insert(bytes.end(), 3, std::uint8_t{0});
    }
    bytes.resize(parts.masks, 0);
    for (const LocalReceiver& receiver : local.receivers) {
        bytes.insert(bytes.end(),
                     receiver.sources.begin(),
                     receiver.sources.begin() + static_cast<std::ptrdiff_t>(mask_bytes));
    }
    for (const LightCodes& pair : local.pairs)
        append_codes(bytes, pair);
    return bytes;
}

Bytes convergence_section(const Convergence& c) {
    Bytes bytes;
    for (float error : {c.error_asked, c.error_median, c.error_p95, c.error_max})
        append_f32(bytes, error);
    for (std::uint32_t n : {c.paths_least, c.paths_most, c.local_bounces, c.local_rays})
        append_le(bytes, n);
    append_le(bytes, c.static_rays);
    append_le(bytes, c.local_transfer_rays);
    return bytes;
}

Bytes interiors_section(const std::vector<Interior>& interiors) {
    using Rooms = layout::InteriorsLayout;
    std::size_t vertices = 0, triangles = 0;
    for (const Interior& interior : interiors) {
        vertices += interior.vertices.size();
        triangles += interior.triangles.size();
    }
    const Rooms parts(interiors.size(), vertices, triangles);
    Bytes bytes;
    bytes.reserve(parts.end);
    append_le(bytes, static_cast<std::uint16_t>(interiors.size()));
    append_le(bytes, std::uint16_t{0});
    append_le(bytes, static_cast<std::uint32_t>(vertices));
    append_le(bytes, static_cast<std::uint32_t>(triangles));
    append_le(bytes, std::uint32_t{0});
    vertices = triangles = 0;
    for (const Interior& interior : interiors) {
        for (const std::int32_t origin : interior.origin_units)
            append_le(bytes, static_cast<std::uint32_t>(origin));
        append_le(bytes, interior.shift);
        append_le(bytes, interior.probe);
        append_le(bytes, std::uint16_t{0});
        for (const std::size_t n : {vertices, interior.vertices.size(), triangles, interior.triangles.size()})
            append_le(bytes, static_cast<std::uint32_t>(n));
        vertices += interior.vertices.size();
        triangles += interior.triangles.size();
    }
    const auto append_triples = [&](const std::vector<std::array<std::uint16_t, 3>>& triples) {
        for (const auto& triple : triples) {
            for (const std::uint16_t value : triple)
                append_le(bytes, value);
        }
    };
    for (const Interior& interior : interiors)
        append_triples(interior.vertices);
    bytes.resize(parts.triangles, 0);
    for (const Interior& interior : interiors)
        append_triples(interior.triangles);
    return bytes;
}

struct StoredSection {
    SectionEntry entry;
    Bytes bytes;
};

// One frame; nothing where it is no smaller than `limit`.
Bytes pack(const Bytes& bytes, int level, std::size_t limit) {
    Bytes packed(ZSTD_compressBound(bytes.size()));
    const std::size_t size = ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), level);
    packed.resize(ZSTD_isError(size) || size >= limit ? 0 : size);
    return packed;
}

StoredSection store_section(SectionKind kind, Bytes raw, Codec codec, std::size_t probe_count) {
    StoredSection section;
    section.entry.kind = static_cast<std::uint16_t>(kind);
    section.entry.version = 1;
    section.entry.raw_bytes = static_cast<std::uint32_t>(raw.size());
    if (codec == Codec::zstd && !raw.empty()) {
        const bool filtered = kind == SectionKind::local_transfer;
        section.bytes = filtered
                            ? pack(filter_local(raw, probe_count), zstd_level_of_local_transfer, raw.size())
                            : pack(raw, zstd_level, raw.size());
        if (!section.bytes.empty()) {
            section.entry.codec = static_cast<std::uint8_t>(filtered ? Codec::filtered : Codec::zstd);
            if (filtered)
                section.entry.version = layout::filtered_local_version;
        }
    }
    if (section.bytes.empty())
        section.bytes = std::move(raw);
    section.entry.stored_bytes = static_cast<std::uint32_t>(section.bytes.size());
    section.entry.checksum = xxh64(section.bytes);
    return section;
}

// The least minor version that knows all of them.
std::uint16_t minor_version(const std::vector<StoredSection>& sections) {
    std::uint16_t minor = 0;
    for (const StoredSection& section : sections) {
        const auto kind = static_cast<SectionKind>(section.entry.kind);
        if (kind >= SectionKind::static_irradiance)
            minor = std::max(minor, layout::minor_with_light_sections);
        if (kind == SectionKind::interiors || section.entry.version == layout::filtered_local_version)
            minor = std::max(minor, layout::minor_with_interiors);
    }
    return minor;
}

void append_entry(Bytes& bytes, const SectionEntry& entry) {
    append_le(bytes, entry.kind);
    append_le(bytes, entry.version);
    append_le(bytes, entry.codec);
    bytes.insert(bytes.end(), 3, std::uint8_t{0});
    append_le(bytes, entry.offset);
    append_le(bytes, entry.stored_bytes);
    append_le(bytes, entry.raw_bytes);
    append_le(bytes, std::uint32_t{0});
    append_le(bytes, entry.checksum);
}

}  // namespace

std::vector<std::uint8_t> write_sector(const Sector& sector, const WriteOptions& options) {
    assert(sector.probes.size() <= max_probes && sector.z_shift <= max_z_shift);
    assert(std::abs(std::int64_t{sector.i}) <= max_sector_coordinate &&
           std::abs(std::int64_t{sector.j}) <= max_sector_coordinate);
    assert(std::abs(std::int64_t{sector.z_origin_units}) <= max_z_origin_units);
    assert(sector.static_irradiance.empty() || sector.static_irradiance.size() == sector.probes.size());
    assert(!sector.local_transfer || (sector.local_transfer->receivers.size() == sector.probes.size() &&
                                      sector.local_transfer->sources.size() <= max_probes));
    assert(sector.interiors.size() <= max_interiors);
    std::vector<StoredSection> sections;
    const auto add = [&](SectionKind kind, Bytes raw) {
        sections.push_back(store_section(kind, std::move(raw), options.codec, sector.probes.size()));
    };
    add(SectionKind::bake, bake_section(sector.bake));
    add(SectionKind::positions, positions_section(sector.probes));
    add(SectionKind::sky_visibility, sky_visibility_section(sector.probes));
    add(SectionKind::transfer, transfer_section(sector.probes));
    add(SectionKind::grid, grid_section(sector.grid));
    add(SectionKind::statistics, statistics_section(sector.statistics));
    if (!sector.static_irradiance.empty())
        add(SectionKind::static_irradiance, static_irradiance_section(sector.static_irradiance));
    if (sector.local_transfer)
        add(SectionKind::local_transfer, local_transfer_section(*sector.local_transfer));
    if (sector.convergence)
        add(SectionKind::convergence, convergence_section(*sector.convergence));
    if (!sector.interiors.empty())
        add(SectionKind::interiors, interiors_section(sector.interiors));

    std::size_t end = layout::header_bytes + sections.size() * layout::entry_bytes;
    for (StoredSection& section : sections) {
        section.entry.offset = static_cast<std::uint32_t>(layout::align(end));
        end = section.entry.offset + section.bytes.size();
    }

    Bytes table;
    for (const StoredSection& section : sections)
        append_entry(table, section.entry);

    Bytes file;
    file.reserve(end);
    append_le(file, layout::magic);
    append_le(file, layout::major_version);
    append_le(file, minor_version(sections));
    append_le(file, static_cast<std::uint32_t>(end));
    append_le(file, static_cast<std::uint32_t>(sections.size()));
    append_le(file, static_cast<std::uint32_t>(sector.i));
    append_le(file, static_cast<std::uint32_t>(sector.j));
    append_le(file, static_cast<std::uint32_t>(sector.z_origin_units));
    append_le(file, static_cast<std::uint16_t>(sector.probes.size()));
    append_le(file, sector.z_shift);
    file.resize(layout::header::checksum, 0);

    // The header's checksum runs over its first 56 bytes and the table.
    Bytes covered = file;
    covered.insert(covered.end(), table.begin(), table.end());
    append_le(file, xxh64(covered));
    file.insert(file.end(), table.begin(), table.end());
    for (const StoredSection& section : sections) {
        file.resize(section.entry.offset, 0);
        file.insert(file.end(), section.bytes.begin(), section.bytes.end());
    }
    return file;
}

}  // namespace drtv
