#include "file_header.h"

#include "checksum.h"
#include "layout.h"
#include "read_failure.h"

#include <drtv/sector.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace drtv {
namespace {

// Whether it is a sector file of a version that this reader knows, whole and not longer.
ReadStatus check_size(ByteSpan file) {
    namespace h = layout::header;
    if (file.size() < 4 || load_u32(file, h::magic) != layout::magic) {
        return fail(
            ReadError::not_a_sector_file, 0, "not a drtv sector file: it does not start with \"DRTV\"");
    }
    // Magic and version come first and stay so in every version, whatever the length of its header.
    if (file.size() >= h::file_bytes && load_u16(file, h::major) != layout::major_version) {
        return fail(ReadError::unsupported_version,
                    h::major,
                    "format version ",
                    load_u16(file, h::major),
                    ".",
                    load_u16(file, h::minor),
                    " is not supported: this reader knows version 1");
    }
    if (file.size() < layout::header_bytes) {
        return fail(
            ReadError::truncated, file.size(), "the header needs 64 bytes, the file has ", file.size());
    }
    const std::size_t said = load_u32(file, h::file_bytes);
    if (file.size() == said)
        return {};
    const bool longer = file.size() > said;
    return fail(longer ? ReadError::trailing_bytes : ReadError::truncated,
                longer ? said : file.size(),
                "the header says ",
                said,
                " bytes, the file has ",
                file.size());
}

// Afterwards the table lies inside the file.
ReadStatus check_section_count(ByteSpan file) {
    namespace h = layout::header;
    const std::size_t section_count = load_u32(file, h::section_count);
    if (section_count <= layout::max_sections && layout::entry_at(section_count) <= file.size())
        return {};
    return fail(ReadError::bad_header,
                h::section_count,
                "the header says ",
                section_count,
                " sections, which do not fit the file or the limit of 64");
}

// It runs over the header before it, and the table.
ReadStatus check_checksum(ByteSpan file) {
    namespace h = layout::header;
    std::array<std::uint8_t, h::checksum + layout::max_sections * layout::entry_bytes> covered;
    const std::size_t table_bytes = load_u32(file, h::section_count) * layout::entry_bytes;
    const ByteSpan header = file.first(h::checksum);
    const ByteSpan table = file.subspan(layout::header_bytes, table_bytes);
    const auto behind_header = std::copy(header.begin(), header.end(), covered.begin());
    std::copy(table.begin(), table.end(), behind_header);
    const std::uint64_t hash = xxh64(ByteSpan(covered).first(h::checksum + table_bytes));
    if (hash == load_u64(file, h::checksum))
        return {};
    return fail(
        ReadError::checksum_mismatch, h::checksum, "the header's checksum does not match header and table");
}

bool is_beyond(std::int32_t coordinate) {
    return std::abs(std::int64_t{coordinate}) > max_sector_coordinate;
}

// What the header says of the sector.
ReadStatus check_sector_fields(ByteSpan file) {
    namespace h = layout::header;
    const std::int32_t i = load_i32(file, h::sector_i);
    const std::int32_t j = load_i32(file, h::sector_j);
    if (is_beyond(i) || is_beyond(j)) {
        return fail(ReadError::bad_header,
                    is_beyond(i) ? h::sector_i : h::sector_j,
                    "sector (",
                    i,
                    ", ",
                    j,
                    ") is beyond the limit of 16384");
    }
    const std::uint16_t probe_count = load_u16(file, h::probe_count);
    if (probe_count > max_probes) {
        return fail(
            ReadError::bad_header, h::probe_count, "probe count ", probe_count, " is over the limit of 255");
    }
    const std::uint8_t z_shift = file[h::z_shift];
    if (z_shift > max_z_shift)
        return fail(ReadError::bad_header, h::z_shift, "z shift ", z_shift, " is over the limit of 10");
    const std::int64_t z_origin = load_i32(file, h::z_origin);
    if (std::abs(z_origin) > max_z_origin_units)
        return fail(ReadError::bad_header, h::z_origin, "z origin ", z_origin, " is over the limit of 2^30");
    if (!all_zero(file.subspan(h::reserved, h::checksum - h::reserved)))
        return fail(ReadError::bad_header, h::reserved, "reserved header bytes are not zero");
    return {};
}

}  // namespace

ReadStatus check_header(ByteSpan file) {
    for (const auto check : {check_size, check_section_count, check_checksum, check_sector_fields}) {
        if (ReadStatus status = check(file); !status.ok())
            return status;
    }
    return {};
}

}  // namespace drtv
