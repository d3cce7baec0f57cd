// The sections of a file, decoded and checked: what reading, opening and unpacking share.
#pragma once

#include <drtv/read.h>
#include <drtv/sector.h>

#include "codec.h"
#include "layout.h"
#include "section_table.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace drtv {

// One section's decoded bytes. They lie in the file where the section is raw.
struct Section {
    std::span<const std::uint8_t> raw;
    layout::Place place;
    std::uint16_t version = 1;
    bool present = false;  // and of a version that this reader knows
};

inline constexpr std::size_t known_kinds = 13;  // kind 0 is none

struct Sections {
    std::size_t probe_count = 0;
    std::array<Section, known_kinds> of_kind;

    [[nodiscard]] const Section& of(SectionKind kind) const {
        return of_kind[static_cast<std::size_t>(kind)];
    }
    [[nodiscard]] bool has(SectionKind kind) const { return of(kind).present; }
    [[nodiscard]] std::span<const std::uint8_t> raw(SectionKind kind) const { return of(kind).raw; }
};

// How compressed sections are decoded (codec.h), and where their bytes lie then.
struct Unpacking {
    ReadStatus (*unpack)(const PackedSection& packed, std::vector<std::uint8_t>& raw);
    std::array<std::vector<std::uint8_t>, known_kinds> sections{};
};

// Checks the whole file by SPEC.md section 6, and gives its table too. With `unpacking` null, a compressed
// section fails. Allocates for compressed sections and for messages only.
ReadStatus load_sections(std::span<const std::uint8_t> file,
                         SectionTable& table,
                         Unpacking* unpacking,
                         Sections& sections);

// The sector that they hold. REQUIRES: load_sections gave them for this file.
void copy_sector(std::span<const std::uint8_t> file, const Sections& sections, Sector& sector);

// The rules for what is in a section, once it is decoded and has a size that it may have.
ReadStatus check_content(SectionKind kind, const Section& section, std::size_t probe_count);

}  // namespace drtv
