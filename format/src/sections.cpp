#include "sections.h"

#include "bytes.h"
#include "read_failure.h"
#include "section_refusal.h"
#include "sentence.h"

#include <drtv/sector.h>

#include <algorithm>

namespace drtv {
namespace {

using Local = layout::LocalTransferLayout;
using Groups = layout::LightGroupsLayout;
using QualityBytes = layout::QualityLayout;

constexpr std::uint16_t last_required_kind = static_cast<std::uint16_t>(SectionKind::statistics);

struct SizeRange {
    std::size_t min;
    std::size_t max;
};

std::size_t max_local_bytes(std::uint16_t version, std::size_t probe_count) {
    const std::size_t sources = Local::max_sources(version);
    return std::min(Local(probe_count, sources, probe_count * sources).end, layout::max_raw_section_bytes);
}

// What a section may have in raw bytes. The content says more where that is a range.
SizeRange raw_size(SectionKind kind, std::uint16_t version, std::size_t probe_count) {
    const auto exactly = [](std::size_t bytes) { return SizeRange{bytes, bytes}; };
    switch (kind) {
        case SectionKind::bake:
            return exactly(layout::bake::bytes);
        case SectionKind::positions:
            return exactly(probe_count * layout::position::bytes);
        case SectionKind::sky_visibility:
            return exactly(probe_count * layout::sky_visibility_bytes);
        case SectionKind::transfer:
            return exactly(probe_count * layout::transfer_bytes);
        case SectionKind::grid:
            return exactly(layout::grid::bytes);
        case SectionKind::statistics:
            return exactly(layout::statistics::bytes);
        case SectionKind::static_irradiance:
            return exactly(probe_count * layout::static_irradiance_bytes);
        case SectionKind::convergence:
            return exactly(layout::convergence::bytes);
        case SectionKind::local_transfer:
            return {Local::header_bytes, max_local_bytes(version, probe_count)};
        case SectionKind::light_groups:
            return {Groups(probe_count, 1).end, Groups(probe_count, max_light_groups).end};
        case SectionKind::quality:
            return {QualityBytes(probe_count, 0).end, QualityBytes(probe_count, max_light_groups).end};
        case SectionKind::interiors:
            break;
    }
    return {layout::InteriorsLayout::header_bytes, layout::max_raw_section_bytes};
}

// Whether the kind was a section already in this minor version, and its version is one this reader knows.
// What is not, is ignored.
bool is_known(const SectionEntry& entry, std::uint16_t minor) {
    const auto kind = static_cast<SectionKind>(entry.kind);
    if (kind >= SectionKind::light_groups)
        return minor >= layout::minor_with_light_groups && entry.version == 1;
    if (kind == SectionKind::interiors)
        return minor >= layout::minor_with_interiors && entry.version == 1;
    if (kind == SectionKind::local_transfer && entry.version == layout::filtered_local_version)
        return minor >= layout::minor_with_interiors;
    if (kind == SectionKind::local_transfer && entry.version == layout::many_sources_local_version)
        return minor >= layout::minor_with_light_groups;
    return minor >= layout::minor_with_light_sections && entry.version == 1;
}

struct SectionSource {
    ByteSpan file;
    const SectionEntry& entry;
    std::size_t probe_count;

    [[nodiscard]] ByteSpan stored() const { return file.subspan(entry.offset, entry.stored_bytes); }
};

ReadStatus check_raw_size(const SectionSource& source) {
    const SectionEntry& entry = source.entry;
    const auto kind = static_cast<SectionKind>(entry.kind);
    const SizeRange size = raw_size(kind, entry.version, source.probe_count);
    if (entry.raw_bytes >= size.min && entry.raw_bytes <= size.max)
        return {};
    const std::string to_max = size.min == size.max ? "" : sentence(" to ", size.max);
    return refuse(entry, " has ", entry.raw_bytes, " bytes, must have ", size.min, to_max);
}

// Of a section of a version that this reader knows.
bool is_known_codec(Codec codec, std::uint16_t version) {
    switch (codec) {
        case Codec::raw:
            return version != layout::filtered_local_version;
        case Codec::zstd:
            return version == 1;
        case Codec::filtered:
            return version != 1;
    }
    return false;
}

ReadStatus check_codec(const SectionSource& source) {
    const SectionEntry& entry = source.entry;
    if (is_known_codec(static_cast<Codec>(entry.codec), entry.version))
        return {};
    return refuse(entry, " of version ", entry.version, " has the unknown codec ", entry.codec);
}

ReadStatus decode(const SectionSource& source, Unpacking* unpacking, Section& section) {
    const SectionEntry& entry = source.entry;
    if (ReadStatus status = check_raw_size(source); !status.ok())
        return status;
    if (ReadStatus status = check_codec(source); !status.ok())
        return status;
    const bool is_raw = static_cast<Codec>(entry.codec) == Codec::raw;
    section.place = {entry.offset, is_raw};
    section.version = entry.version;
    section.present = true;
    if (is_raw) {
        section.raw = source.stored();
        return {};
    }
    if (unpacking == nullptr) {
        return fail(ReadError::compressed,
                    entry.offset,
                    section_name(entry),
                    " is compressed: unpack the file first (unpack_sector, or drtv strip)");
    }
    std::vector<std::uint8_t>& raw = unpacking->sections[entry.kind];
    const PackedSection packed{source.stored(), entry, source.probe_count, Local::max_sources(entry.version)};
    if (ReadStatus status = unpacking->unpack(packed, raw); !status.ok())
        return status;
    section.raw = raw;
    return {};
}

ReadStatus check_required(const SectionEntry* entry, std::uint16_t kind) {
    if (entry == nullptr)
        return fail(ReadError::missing_section, 0, "the ", name_of_section(kind), " section is missing");
    if (entry->version == 1)
        return {};
    return fail(ReadError::unsupported_version,
                entry->offset,
                section_name(*entry),
                " has version ",
                entry->version,
                ", this reader knows 1");
}

}  // namespace

ReadStatus load_sections(ByteSpan file, SectionTable& table, Unpacking* unpacking, Sections& sections) {
    if (ReadStatus status = load_section_table(file, table); !status.ok())
        return status;
    const std::uint16_t minor = load_u16(file, layout::header::minor);
    const std::size_t probe_count = load_u16(file, layout::header::probe_count);
    sections.probe_count = probe_count;
    for (std::uint16_t k = 1; k < known_kinds; ++k) {
        const auto kind = static_cast<SectionKind>(k);
        const SectionEntry* entry = table.find(kind);
        if (k <= last_required_kind) {
            if (ReadStatus status = check_required(entry, k); !status.ok())
                return status;
        } else if (entry == nullptr || !is_known(*entry, minor)) {
            continue;
        }
        Section& section = sections.of_kind[k];
        if (ReadStatus status = decode({file, *entry, probe_count}, unpacking, section); !status.ok())
            return status;
        if (ReadStatus status = check_content(kind, section, probe_count); !status.ok())
            return status;
    }
    return {};
}

}  // namespace drtv
