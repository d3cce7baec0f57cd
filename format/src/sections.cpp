#include "sections.h"

#include "bytes.h"
#include "local_filter.h"

#include <drtv/sector.h>

#include <zstd.h>

#include <algorithm>

namespace drtv {
namespace {

using Local = layout::LocalTransferLayout;

constexpr std::uint16_t last_required_kind = static_cast<std::uint16_t>(SectionKind::statistics);

struct SizeRange {
    std::size_t least, most;
};

// What a section may have in raw bytes. The content says more where that is a range.
SizeRange raw_size(SectionKind kind, std::size_t probe_count) {
    const auto exactly = [](std::size_t bytes) { return SizeRange{bytes, bytes}; };
    switch (kind) {
        case SectionKind::bake:
            return exactly(layout::bake_bytes);
        case SectionKind::positions:
            return exactly(probe_count * layout::position_bytes);
        case SectionKind::sky_visibility:
            return exactly(probe_count * layout::sky_visibility_bytes);
        case SectionKind::transfer:
            return exactly(probe_count * layout::transfer_bytes);
        case SectionKind::grid:
            return exactly(layout::grid_bytes);
        case SectionKind::statistics:
            return exactly(layout::statistics_bytes);
        case SectionKind::static_irradiance:
            return exactly(probe_count * layout::static_irradiance_bytes);
        case SectionKind::convergence:
            return exactly(layout::convergence_bytes);
        case SectionKind::local_transfer:
            return {Local::header_bytes, Local(probe_count, max_probes, probe_count * max_probes).end};
        case SectionKind::interiors:
            break;
    }
    return {layout::InteriorsLayout::header_bytes, layout::max_raw_section_bytes};
}

// Whether the kind was a section already in this minor version, and its version is one this reader knows.
// What is not, is ignored.
bool is_known(const SectionEntry& entry, std::uint16_t minor) {
    const auto kind = static_cast<SectionKind>(entry.kind);
    if (kind == SectionKind::interiors)
        return minor >= layout::minor_with_interiors && entry.version == 1;
    if (kind == SectionKind::local_transfer && entry.version == layout::filtered_local_version)
        return minor >= layout::minor_with_interiors;
    return minor >= layout::minor_with_light_sections && entry.version == 1;
}

// One Zstandard frame, whole and alone: no skippable frame, none of a format before 0.8, nothing behind it.
bool is_one_frame(ByteSpan stored) {
    return stored.size() >= 4 && load_u32(stored, 0) == ZSTD_MAGICNUMBER &&
           ZSTD_findFrameCompressedSize(stored.data(), stored.size()) == stored.size();
}

// The frame's bytes; false where it has more than `out` holds, or is none. `out` is cut to what there was.
bool unpack_frame(ByteSpan stored, std::vector<std::uint8_t>& out) {
    const std::size_t size = ZSTD_decompress(out.data(), out.size(), stored.data(), stored.size());
    if (ZSTD_isError(size))
        return false;
    out.resize(size);
    return true;
}

ReadStatus decode(
    ByteSpan file, const SectionEntry& entry, std::size_t probe_count, Unpacked* unpacked, Section& section) {
    const auto refuse = [&](const std::string& what) {
        return fail(ReadError::bad_section, entry.offset, section_name(entry) + what);
    };
    const SizeRange size = raw_size(static_cast<SectionKind>(entry.kind), probe_count);
    if (entry.raw_bytes < size.least || entry.raw_bytes > size.most) {
        return refuse(" has " + std::to_string(entry.raw_bytes) + " bytes, must have " +
                      std::to_string(size.least) +
                      (size.least == size.most ? "" : " to " + std::to_string(size.most)));
    }
    const ByteSpan stored = file.subspan(entry.offset, entry.stored_bytes);
    const auto codec = static_cast<Codec>(entry.codec);
    const bool filtered = entry.version == layout::filtered_local_version;
    section.place = {entry.offset, codec == Codec::raw};
    section.present = true;
    if (filtered ? codec != Codec::filtered : codec != Codec::raw && codec != Codec::zstd) {
        return refuse(" of version " + std::to_string(entry.version) + " has the unknown codec " +
                      std::to_string(entry.codec));
    }
    if (codec == Codec::raw) {
        section.raw = stored;
        return {};
    }
    if (unpacked == nullptr)
        return fail(ReadError::compressed,
                    entry.offset,
                    section_name(entry) + " is compressed, unpack the file first");
    if (!is_one_frame(stored))
        return refuse(": its " + std::to_string(stored.size()) + " bytes are not one whole zstd frame");
    std::vector<std::uint8_t>& raw = (*unpacked)[entry.kind];
    raw.resize(filtered ? max_filtered_bytes(entry.raw_bytes) : entry.raw_bytes);
    if (!unpack_frame(stored, raw) || (!filtered && raw.size() != entry.raw_bytes)) {
        return refuse(": its zstd frame does not decode to " + std::to_string(entry.raw_bytes) + " bytes");
    }
    if (filtered) {
        const std::vector<std::uint8_t> planes = std::move(raw);
        if (!unfilter_local(planes, probe_count, entry.raw_bytes, raw)) {
            return refuse(": the " + std::to_string(planes.size()) +
                          " bytes of its zstd frame are not a filtered section of " +
                          std::to_string(entry.raw_bytes) + " bytes");
        }
    }
    section.raw = raw;
    return {};
}

}  // namespace

ReadStatus load_sections(ByteSpan file, SectionTable& table, Unpacked* unpacked, Sections& sections) {
    if (ReadStatus status = load_section_table(file, table); !status.ok())
        return status;
    const auto minor = load_u16(file, layout::header::minor);
    sections.probe_count = load_u16(file, layout::header::probe_count);
    for (std::uint16_t k = 1; k < known_kinds; ++k) {
        const auto kind = static_cast<SectionKind>(k);
        const SectionEntry* entry = table.find(kind);
        if (k <= last_required_kind) {
            if (entry == nullptr)
                return fail(ReadError::missing_section,
                            0,
                            "the " + std::string(name_of_section(k)) + " section is missing");
            if (entry->version != 1) {
                return fail(ReadError::unsupported_version,
                            entry->offset,
                            section_name(*entry) + " has version " + std::to_string(entry->version) +
                                ", this reader knows 1");
            }
        } else if (entry == nullptr || !is_known(*entry, minor)) {
            continue;
        }
        Section& section = sections.of_kind[k];
        if (ReadStatus status = decode(file, *entry, sections.probe_count, unpacked, section); !status.ok())
            return status;
        if (ReadStatus status = check_content(kind, section, sections.probe_count); !status.ok())
            return status;
    }
    return {};
}

}  // namespace drtv
