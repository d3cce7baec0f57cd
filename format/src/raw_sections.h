// The sections of a sector as bytes (SPEC.md, section 5), before any of them is compressed.
#pragma once

#include <drtv/read.h>
#include <drtv/sector.h>

#include <cstdint>
#include <vector>

namespace drtv {

struct RawSection {
    SectionKind kind;
    std::vector<std::uint8_t> bytes;
    std::uint16_t version = 1;  // with the codec raw
};

// All that the sector has, in the order of their kinds; an optional one where there is something to write.
// REQUIRES: what write_sector requires (drtv/write.h).
[[nodiscard]] std::vector<RawSection> raw_sections(const Sector& sector);

}  // namespace drtv
