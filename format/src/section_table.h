// Header and table of sections, without a copy of either.
#pragma once

#include <drtv/read.h>

#include "layout.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace drtv {

struct SectionTable {
    std::array<SectionEntry, layout::max_sections> entries;
    std::size_t count = 0;

    // Null where the file has no such section.
    [[nodiscard]] const SectionEntry* find(SectionKind kind) const;
};

// Checks header, table and every checksum.
ReadStatus load_section_table(std::span<const std::uint8_t> file, SectionTable& table);

// "grid section (kind 5)"
[[nodiscard]] std::string section_name(const SectionEntry& entry);

}  // namespace drtv
