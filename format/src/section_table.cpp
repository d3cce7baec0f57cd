// Everything that holds before a section is looked into.
#include "section_table.h"

#include "bytes.h"
#include "checksum.h"

#include <algorithm>
#include <cstdlib>

namespace drtv {
namespace {

SectionEntry load_entry(ByteSpan file, std::size_t at) {
    namespace e = layout::entry;
    return {load_u16(file, at + e::kind),
            load_u16(file, at + e::version),
            file[at + e::codec],
            load_u32(file, at + e::offset),
            load_u32(file, at + e::stored_bytes),
            load_u32(file, at + e::raw_bytes),
            load_u64(file, at + e::checksum)};
}

ReadStatus check_header(ByteSpan file, std::size_t& section_count) {
    namespace h = layout::header;
    if (file.size() < 4 || load_u32(file, h::magic) != layout::magic) {
        return fail(
            ReadError::not_a_sector_file, 0, "not a drtv sector file: it does not start with \"DRTV\"");
    }
    // Magic and version come first and stay so in every version, whatever the length of its header.
    if (file.size() >= h::file_bytes && load_u16(file, h::major) != layout::major_version) {
        return fail(ReadError::unsupported_version,
                    h::major,
                    "format version " + std::to_string(load_u16(file, h::major)) + "." +
                        std::to_string(load_u16(file, h::minor)) +
                        " is not supported: this reader knows version 1");
    }
    if (file.size() < layout::header_bytes) {
        return fail(ReadError::truncated,
                    file.size(),
                    "the header needs 64 bytes, the file has " + std::to_string(file.size()));
    }
    const auto file_bytes = load_u32(file, h::file_bytes);
    if (file.size() < file_bytes) {
        return fail(ReadError::truncated,
                    file.size(),
                    "the header says " + std::to_string(file_bytes) + " bytes, the file has " +
                        std::to_string(file.size()));
    }
    if (file.size() > file_bytes) {
        return fail(ReadError::trailing_bytes,
                    file_bytes,
                    "the header says " + std::to_string(file_bytes) + " bytes, the file has " +
                        std::to_string(file.size()));
    }
    section_count = load_u32(file, h::section_count);
    if (section_count > layout::max_sections ||
        layout::header_bytes + section_count * layout::entry_bytes > file.size()) {
        return fail(ReadError::bad_header,
                    h::section_count,
                    "the header says " + std::to_string(section_count) +
                        " sections, which do not fit the file or the limit of 64");
    }
    std::array<std::uint8_t, h::checksum + layout::max_sections * layout::entry_bytes> covered;
    const ByteSpan table = file.subspan(layout::header_bytes, section_count * layout::entry_bytes);
    std::copy_n(file.begin(), h::checksum, covered.begin());
    std::copy(table.begin(), table.end(), covered.begin() + h::checksum);
    if (xxh64(ByteSpan(covered).first(h::checksum + table.size())) != load_u64(file, h::checksum)) {
        return fail(ReadError::checksum_mismatch,
                    h::checksum,
                    "the header's checksum does not match header and table");
    }
    const auto i = load_i32(file, h::sector_i), j = load_i32(file, h::sector_j);
    if (std::abs(std::int64_t{i}) > max_sector_coordinate ||
        std::abs(std::int64_t{j}) > max_sector_coordinate) {
        return fail(
            ReadError::bad_header,
            std::abs(std::int64_t{i}) > max_sector_coordinate ? h::sector_i : h::sector_j,
            "sector (" + std::to_string(i) + ", " + std::to_string(j) + ") is beyond the limit of 16384");
    }
    const auto probe_count = load_u16(file, h::probe_count);
    if (probe_count > max_probes) {
        return fail(ReadError::bad_header,
                    h::probe_count,
                    "probe count " + std::to_string(probe_count) + " is over the limit of 255");
    }
    if (file[h::z_shift] > max_z_shift) {
        return fail(ReadError::bad_header,
                    h::z_shift,
                    "z shift " + std::to_string(file[h::z_shift]) + " is over the limit of 10");
    }
    if (std::abs(std::int64_t{load_i32(file, h::z_origin)}) > max_z_origin_units) {
        return fail(ReadError::bad_header,
                    h::z_origin,
                    "z origin " + std::to_string(load_i32(file, h::z_origin)) + " is over the limit of 2^30");
    }
    if (!all_zero(file.subspan(h::reserved, h::checksum - h::reserved))) {
        return fail(ReadError::bad_header, h::reserved, "reserved header bytes are not zero");
    }
    return {};
}

ReadStatus check_entry(ByteSpan file, std::size_t at, const SectionEntry& entry, std::size_t& end) {
    const auto name = [&] { return section_name(entry); };  // only a refusal is worth the string
    if (!all_zero(file.subspan(at + layout::entry::reserved, 3)) ||
        load_u32(file, at + layout::entry::reserved2) != 0) {
        return fail(ReadError::bad_table, at, name() + ": reserved bytes of its entry are not zero");
    }
    if (entry.offset != layout::align(end)) {
        return fail(ReadError::bad_table,
                    at,
                    name() + " starts at " + std::to_string(entry.offset) + ", must start at " +
                        std::to_string(layout::align(end)));
    }
    if (entry.stored_bytes > file.size() || entry.offset > file.size() - entry.stored_bytes) {
        return fail(ReadError::bad_table,
                    at,
                    name() + " ends at " + std::to_string(std::uint64_t{entry.offset} + entry.stored_bytes) +
                        ", the file has " + std::to_string(file.size()) + " bytes");
    }
    if (entry.raw_bytes > layout::max_raw_section_bytes) {
        return fail(
            ReadError::bad_table,
            at,
            name() + " decodes to " + std::to_string(entry.raw_bytes) + " bytes, over the limit of 16 MiB");
    }
    if (entry.codec == static_cast<std::uint8_t>(Codec::raw) && entry.raw_bytes != entry.stored_bytes) {
        return fail(ReadError::bad_table,
                    at,
                    name() + " is raw but says " + std::to_string(entry.stored_bytes) + " stored and " +
                        std::to_string(entry.raw_bytes) + " raw bytes");
    }
    if (!all_zero(file.subspan(end, entry.offset - end))) {
        return fail(ReadError::bad_table, end, name() + ": the padding before it is not zero");
    }
    if (xxh64(file.subspan(entry.offset, entry.stored_bytes)) != entry.checksum) {
        return fail(
            ReadError::checksum_mismatch, entry.offset, name() + ": its checksum does not match its bytes");
    }
    end = std::size_t{entry.offset} + entry.stored_bytes;
    return {};
}

}  // namespace

constexpr std::array<std::pair<SectionKind, std::string_view>, 10> section_names = {
    {{SectionKind::bake, "bake"},
     {SectionKind::positions, "positions"},
     {SectionKind::sky_visibility, "sky visibility"},
     {SectionKind::transfer, "transfer"},
     {SectionKind::grid, "grid"},
     {SectionKind::statistics, "statistics"},
     {SectionKind::static_irradiance, "static irradiance"},
     {SectionKind::local_transfer, "local transfer"},
     {SectionKind::convergence, "convergence"},
     {SectionKind::interiors, "interiors"}}};

std::string_view name_of_section(std::uint16_t kind) {
    const auto* found = std::ranges::find(
        section_names, static_cast<SectionKind>(kind), &std::pair<SectionKind, std::string_view>::first);
    return found == section_names.end() ? "unknown" : found->second;
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
    std::size_t section_count = 0;
    if (ReadStatus status = check_header(file, section_count); !status.ok())
        return status;
    std::size_t end = layout::header_bytes + section_count * layout::entry_bytes;
    for (std::size_t n = 0; n < section_count; ++n) {
        const std::size_t at = layout::header_bytes + n * layout::entry_bytes;
        const SectionEntry entry = load_entry(file, at);
        if (ReadStatus status = check_entry(file, at, entry, end); !status.ok())
            return status;
        if (table.find(static_cast<SectionKind>(entry.kind)) != nullptr)
            return fail(ReadError::bad_table, at, section_name(entry) + " stands twice in the table");
        table.entries[table.count++] = entry;
    }
    if (end != file.size()) {
        return fail(ReadError::bad_table,
                    end,
                    "the last section ends at " + std::to_string(end) + ", the file has " +
                        std::to_string(file.size()) + " bytes");
    }
    return {};
}

ReadStatus read_section_table(ByteSpan bytes, std::vector<SectionEntry>& entries) {
    entries.clear();
    SectionTable table;
    ReadStatus status = load_section_table(bytes, table);
    if (status.ok())
        entries.assign(table.entries.begin(),
                       table.entries.begin() + static_cast<std::ptrdiff_t>(table.count));
    return status;
}

}  // namespace drtv
