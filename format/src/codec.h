// The compressor behind sections (SPEC.md, sections 4.2 and 5.10): of codec_zstd.cpp, or of codec_none.cpp in
// a library that is built without. What reads raw files alone links neither.
#pragma once

#include <drtv/read.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace drtv {

// A compressed section as it stands in the file.
struct PackedSection {
    std::span<const std::uint8_t> stored;
    const SectionEntry& entry;
    std::size_t probe_count;
    std::size_t max_sources;  // of a filtered one
};

// The raw bytes, as many as the entry says. On error `raw` is anything.
[[nodiscard]] ReadStatus unpack_section(const PackedSection& packed, std::vector<std::uint8_t>& raw);

// One zstd frame of the bytes, filtered first where asked; nothing where that is no smaller than they are.
[[nodiscard]] std::vector<std::uint8_t> pack_section(std::span<const std::uint8_t> raw,
                                                     bool filtered,
                                                     std::size_t probe_count);

}  // namespace drtv
