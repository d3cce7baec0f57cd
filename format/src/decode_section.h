// One section's bytes, decoded, and how a reader says what is wrong with them.
#pragma once

#include <drtv/read.h>

#include "layout.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace drtv {

struct DecodedSection {
    std::vector<std::uint8_t> raw;
    layout::Place place;
};

[[nodiscard]] inline ReadStatus fail(ReadError error, std::uint64_t offset, std::string message) {
    return {error, offset, std::move(message)};
}

// "grid section (kind 5)"
[[nodiscard]] std::string section_name(const SectionEntry& entry);

[[nodiscard]] const SectionEntry* find_section(std::span<const SectionEntry> entries, SectionKind kind);

// Fails where the section is not `raw_bytes` long, or cannot be decoded. REQUIRES: the entry passed read_section_table.
ReadStatus decode_section(std::span<const std::uint8_t> file, const SectionEntry& entry, std::size_t raw_bytes, DecodedSection& out);

}  // namespace drtv
