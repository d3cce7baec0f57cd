#include <drtv/write.h>

#include "bytes.h"
#include "checksum.h"
#include "codec.h"
#include "layout.h"
#include "raw_sections.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>

namespace drtv {
namespace {

struct StoredSection {
    SectionEntry entry;
    ByteVector bytes;
};

// Leaves the section raw where it would not become smaller.
void compress(StoredSection& section, bool filtered, std::size_t probe_count) {
    ByteVector packed = pack_section(section.bytes, filtered, probe_count);
    if (packed.empty())
        return;
    section.bytes = std::move(packed);
    section.entry.codec = static_cast<std::uint8_t>(filtered ? Codec::filtered : Codec::zstd);
    if (filtered && section.entry.version == 1)
        section.entry.version = layout::filtered_local_version;
}

StoredSection store(RawSection raw, Codec codec, std::size_t probe_count) {
    StoredSection section{{}, std::move(raw.bytes)};
    SectionEntry& entry = section.entry;
    entry.kind = static_cast<std::uint16_t>(raw.kind);
    entry.version = raw.version;
    entry.raw_bytes = static_cast<std::uint32_t>(section.bytes.size());
    if (codec == Codec::zstd && !section.bytes.empty())
        compress(section, raw.kind == SectionKind::local_transfer, probe_count);
    entry.stored_bytes = static_cast<std::uint32_t>(section.bytes.size());
    entry.checksum = xxh64(section.bytes);
    return section;
}

// Each section begins at the next multiple of 16 behind the one before. Gives the file's end.
std::size_t place(std::vector<StoredSection>& sections) {
    std::size_t end = layout::header_bytes + sections.size() * layout::entry_bytes;
    for (StoredSection& section : sections) {
        const std::size_t start = layout::align(end);
        section.entry.offset = static_cast<std::uint32_t>(start);
        end = start + section.bytes.size();
    }
    return end;
}

// The least minor version that knows all of them.
std::uint16_t minor_version(const std::vector<StoredSection>& sections) {
    std::uint16_t minor = 0;
    for (const StoredSection& section : sections) {
        const auto kind = static_cast<SectionKind>(section.entry.kind);
        const bool filtered = section.entry.version == layout::filtered_local_version;
        const bool many_sources = section.entry.version == layout::many_sources_local_version;
        if (kind >= SectionKind::static_irradiance)
            minor = std::max(minor, layout::minor_with_light_sections);
        if (kind == SectionKind::interiors || filtered)
            minor = std::max(minor, layout::minor_with_interiors);
        if (kind >= SectionKind::light_groups || many_sources)
            minor = std::max(minor, layout::minor_with_light_groups);
    }
    return minor;
}

// The header up to its checksum.
ByteVector header_of(const Sector& sector, const std::vector<StoredSection>& sections, std::size_t end) {
    ByteVector header;
    append_le(header, layout::magic);
    append_le(header, layout::major_version);
    append_le(header, minor_version(sections));
    append_u32(header, end);
    append_u32(header, sections.size());
    append_le(header, sector.i);
    append_le(header, sector.j);
    append_le(header, sector.z_origin_units);
    append_u16(header, sector.probes.size());
    append_le(header, sector.z_shift);
    header.resize(layout::header::checksum, 0);
    return header;
}

void append_entry(ByteVector& bytes, const SectionEntry& entry) {
    append_le(bytes, entry.kind);
    append_le(bytes, entry.version);
    append_le(bytes, entry.codec);
    append_zeros(bytes, 3);
    append_le(bytes, entry.offset);
    append_le(bytes, entry.stored_bytes);
    append_le(bytes, entry.raw_bytes);
    append_zeros(bytes, 4);
    append_le(bytes, entry.checksum);
}

// What write_sector requires.
void assert_limits([[maybe_unused]] const Sector& sector) {
    assert(sector.probes.size() <= max_probes);
    assert(sector.z_shift <= max_z_shift);
    assert(std::abs(std::int64_t{sector.i}) <= max_sector_coordinate);
    assert(std::abs(std::int64_t{sector.j}) <= max_sector_coordinate);
    assert(std::abs(std::int64_t{sector.z_origin_units}) <= max_z_origin_units);
    assert(sector.static_irradiance.empty() || sector.static_irradiance.size() == sector.probes.size());
    assert(!sector.local_transfer || sector.local_transfer->receivers.size() == sector.probes.size());
    assert(!sector.local_transfer || sector.local_transfer->sources.size() <= max_sector_sources);
    assert(sector.interiors.size() <= max_interiors);
    assert(sector.light_groups.size() <= max_light_groups);
    for ([[maybe_unused]] const LightGroup& group : sector.light_groups) {
        assert(!group.name.empty() && group.name.size() <= max_light_group_name);
        assert(group.irradiance.size() == sector.probes.size());
    }
    assert(!sector.quality || sector.quality->probes.size() == sector.probes.size());
}

}  // namespace

std::vector<std::uint8_t> write_sector(const Sector& sector, const WriteOptions& options) {
    assert_limits(sector);
    std::vector<StoredSection> sections;
    for (RawSection& raw : raw_sections(sector))
        sections.push_back(store(std::move(raw), options.codec, sector.probes.size()));
    const std::size_t end = place(sections);

    ByteVector table;
    for (const StoredSection& section : sections)
        append_entry(table, section.entry);

    ByteVector file = header_of(sector, sections, end);
    file.reserve(end);
    // The header's checksum runs over its first 56 bytes and the table.
    ByteVector covered = file;
    append_bytes(covered, table);
    append_le(file, xxh64(covered));
    append_bytes(file, table);
    for (const StoredSection& section : sections) {
        file.resize(section.entry.offset, 0);
        append_bytes(file, section.bytes);
    }
    return file;
}

}  // namespace drtv
