// Reads a sector file from untrusted bytes. Never throws on bad input and never reads outside `bytes`.
// Allocates at most about twice the decoded size of the sections, which is some kilobytes and at most 16 MiB
// per section.
//
// Pure functions, thread-safe. A file of 70 probes takes some 50 us, most of that for zstd where the file is
// compressed. Games open raw files in place, without a copy: drtv/view.h.
//
//     drtv::Sector sector;
//     const drtv::ReadStatus status = drtv::read_sector(bytes, sector);
//     if (!status.ok()) puts(status.message.c_str());          // what, where, value
#pragma once

#include <drtv/sector.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace drtv {

enum class ReadError : std::uint8_t {
    none,
    not_a_sector_file,    // too short, or another magic
    unsupported_version,  // another major version, or a required section of another version
    truncated,            // the file is shorter than it says
    trailing_bytes,       // the file is longer than it says
    bad_header,           // a header field breaks its rule
    bad_table,            // a section entry breaks its rule
    checksum_mismatch,    // header or section bytes were changed
    missing_section,      // a required section is not there
    bad_section,          // a section's content breaks its rule
    compressed,           // a section is not raw: from open_sector, or a library built without zstd
    misaligned,           // open_sector only: the bytes do not start at a multiple of 16
};

struct [[nodiscard]] ReadStatus {
    ReadError error = ReadError::none;
    // Byte in the file at which the rule is broken; inside a compressed section, that section's first byte.
    std::uint64_t offset = 0;
    std::string message;  // what, where, value; empty when there is no error

    [[nodiscard]] bool ok() const { return error == ReadError::none; }
};

enum class SectionKind : std::uint16_t {
    bake = 1,
    positions = 2,
    sky_visibility = 3,
    transfer = 4,
    grid = 5,
    statistics = 6,
    static_irradiance = 7,  // this and the following: format 1.1, optional
    local_transfer = 8,
    convergence = 9,
    interiors = 10,     // format 1.2, optional
    light_groups = 11,  // this and the following: format 1.3, optional
    quality = 12,
};

enum class Codec : std::uint8_t {
    raw = 0,
    zstd = 1,
    filtered = 2,  // a filter, then zstd (SPEC.md, section 5.10): local transfer of section version 2 or 3
};

// One entry of the file's table of sections.
struct SectionEntry {
    std::uint16_t kind = 0;  // a SectionKind, or one that this reader skips
    std::uint16_t version = 0;
    std::uint8_t codec = 0;
    std::uint32_t offset = 0;        // from the start of the file, a multiple of 16
    std::uint32_t stored_bytes = 0;  // in the file
    std::uint32_t raw_bytes = 0;     // after decoding
    std::uint64_t checksum = 0;      // XXH64 of the stored bytes
};

// "bake", "positions", ... or "unknown".
[[nodiscard]] std::string_view name_of_section(std::uint16_t kind);

// Checks structure and checksums and fills `entries` in the order of the file. On error `entries` is empty.
ReadStatus read_section_table(std::span<const std::uint8_t> bytes, std::vector<SectionEntry>& entries);

// Reads the whole sector. On error `sector` is left as it was.
ReadStatus read_sector(std::span<const std::uint8_t> bytes, Sector& sector);

}  // namespace drtv
