#include "section_table.h"

#include "bytes.h"
#include "checksum.h"
#include "file_header.h"
#include "read_failure.h"

#include <algorithm>

namespace drtv {
namespace {

SectionEntry load_section_entry(ByteSpan file, std::size_t n) {
    namespace e = layout::entry;
    const ByteSpan bytes = file.subspan(layout::entry_at(n), layout::entry_bytes);
    SectionEntry entry;
    entry.kind = load_u16(bytes, e::kind);
    entry.version = load_u16(bytes, e::version);
    entry.codec = bytes[e::codec];
    entry.offset = load_u32(bytes, e::offset);
    entry.stored_bytes = load_u32(bytes, e::stored_bytes);
    entry.raw_bytes = load_u32(bytes, e::raw_bytes);
    entry.checksum = load_u64(bytes, e::checksum);
    return entry;
}

std::uint64_t end_of(const SectionEntry& entry) {
    return std::uint64_t{entry.offset} + entry.stored_bytes;
}

// Entry n; the section before it ends at `end`.
ReadStatus check_entry(ByteSpan file, std::size_t n, const SectionEntry& entry, std::size_t end) {
    const std::size_t at = layout::entry_at(n);
    const bool reserved_is_zero = all_zero(file.subspan(at + layout::entry::reserved, 3)) &&
                                  load_u32(file, at + layout::entry::reserved2) == 0;
    if (!reserved_is_zero) {
        return fail(
            ReadError::bad_table, at, section_name(entry), ": reserved bytes of its entry are not zero");
    }
    if (entry.offset != layout::align(end)) {
        return fail(ReadError::bad_table,
                    at,
                    section_name(entry),
                    " starts at ",
                    entry.offset,
                    ", must start at ",
                    layout::align(end));
    }
    if (end_of(entry) > file.size()) {
        return fail(ReadError::bad_table,
                    at,
                    section_name(entry),
                    " ends at ",
                    end_of(entry),
                    ", the file has ",
                    file.size(),
                    " bytes");
    }
    if (entry.raw_bytes > layout::max_raw_section_bytes) {
        return fail(ReadError::bad_table,
                    at,
                    section_name(entry),
                    " decodes to ",
                    entry.raw_bytes,
                    " bytes, over the limit of 16 MiB");
    }
    const bool raw = entry.codec == static_cast<std::uint8_t>(Codec::raw);
    if (raw && entry.raw_bytes != entry.stored_bytes) {
        return fail(ReadError::bad_table,
                    at,
                    section_name(entry),
                    " is raw but says ",
                    entry.stored_bytes,
                    " stored and ",
                    entry.raw_bytes,
                    " raw bytes");
    }
    return {};
}

// The bytes of the section and the padding before it.
ReadStatus check_stored(ByteSpan file, const SectionEntry& entry, std::size_t end) {
    if (!all_zero(file.subspan(end, entry.offset - end)))
        return fail(ReadError::bad_table, end, section_name(entry), ": the padding before it is not zero");
    if (xxh64(file.subspan(entry.offset, entry.stored_bytes)) == entry.checksum)
        return {};
    return fail(ReadError::checksum_mismatch,
                entry.offset,
                section_name(entry),
                ": its checksum does not match its bytes");
}

}  // namespace

constexpr std::array<std::pair<SectionKind, std::string_view>, 12> section_names = {
    {{SectionKind::bake, "bake"},
     {SectionKind::positions, "positions"},
     {SectionKind::sky_visibility, "sky visibility"},
     {SectionKind::transfer, "transfer"},
     {SectionKind::grid, "grid"},
     {SectionKind::statistics, "statistics"},
     {SectionKind::static_irradiance, "static irradiance"},
     {SectionKind::local_transfer, "local transfer"},
     {SectionKind::convergence, "convergence"},
     {SectionKind::interiors, "interiors"},
     {SectionKind::light_groups, "light groups"},
     {SectionKind::quality, "quality"}}};

std::string_view name_of_section(std::uint16_t kind) {
    for (const auto& [known, name] : section_names) {
        if (known == static_cast<SectionKind>(kind))
            return name;
    }
    return "unknown";
}

std::string section_name(const SectionEntry& entry) {
    return std::string(name_of_section(entry.kind)) + " section (kind " + std::to_string(entry.kind) + ")";
}

const SectionEntry* SectionTable::find(SectionKind kind) const {
    for (std::size_t n = 0; n < count; ++n) {
        if (entries[n].kind == static_cast<std::uint16_t>(kind))
            return &entries[n];
    }
    return nullptr;
}

ReadStatus load_section_table(ByteSpan file, SectionTable& table) {
    table.count = 0;
    if (ReadStatus status = check_header(file); !status.ok())
        return status;
    const std::size_t section_count = load_u32(file, layout::header::section_count);
    std::size_t end = layout::entry_at(section_count);
    for (std::size_t n = 0; n < section_count; ++n) {
        const SectionEntry entry = load_section_entry(file, n);
        if (ReadStatus status = check_entry(file, n, entry, end); !status.ok())
            return status;
        if (ReadStatus status = check_stored(file, entry, end); !status.ok())
            return status;
        if (table.find(static_cast<SectionKind>(entry.kind)) != nullptr) {
            return fail(
                ReadError::bad_table, layout::entry_at(n), section_name(entry), " stands twice in the table");
        }
        table.entries[table.count] = entry;
        ++table.count;
        end = static_cast<std::size_t>(end_of(entry));
    }
    if (end == file.size())
        return {};
    return fail(ReadError::bad_table,
                end,
                "the last section ends at ",
                end,
                ", the file has ",
                file.size(),
                " bytes");
}

}  // namespace drtv
