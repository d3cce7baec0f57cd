#include "decode_section.h"

#include "bytes.h"

#include <zstd.h>

#include <algorithm>

namespace drtv {
namespace {

using Bytes = std::span<const std::uint8_t>;

// One Zstandard frame, whole and alone: no skippable frame, none of a format before 0.8, nothing behind it.
bool is_one_frame(Bytes stored) {
    return stored.size() >= 4 && load_le<std::uint32_t>(stored, 0) == ZSTD_MAGICNUMBER &&
           ZSTD_findFrameCompressedSize(stored.data(), stored.size()) == stored.size();
}

}  // namespace

std::string section_name(const SectionEntry& entry) {
    return std::string(name_of_section(entry.kind)) + " section (kind " + std::to_string(entry.kind) + ")";
}

const SectionEntry* find_section(std::span<const SectionEntry> entries, SectionKind kind) {
    const auto found = std::find_if(entries.begin(), entries.end(), [&](const SectionEntry& entry) { return entry.kind == static_cast<std::uint16_t>(kind); });
    return found == entries.end() ? nullptr : &*found;
}

ReadStatus decode_section(Bytes file, const SectionEntry& entry, std::size_t raw_bytes, DecodedSection& out) {
    const bool is_raw = entry.codec == static_cast<std::uint8_t>(Codec::raw);
    const auto refuse = [&](const std::string& what) { return fail(ReadError::bad_section, entry.offset, section_name(entry) + what); };
    out.place = {entry.offset, is_raw};
    if (entry.raw_bytes != raw_bytes) {
        return refuse(" has " + std::to_string(entry.raw_bytes) + " bytes, must have " + std::to_string(raw_bytes));
    }
    const Bytes stored = file.subspan(entry.offset, entry.stored_bytes);
    if (is_raw) {
        out.raw.assign(stored.begin(), stored.end());
        return {};
    }
    if (entry.codec != static_cast<std::uint8_t>(Codec::zstd)) return refuse(" has the unknown codec " + std::to_string(entry.codec));
    if (!is_one_frame(stored)) return refuse(": its " + std::to_string(stored.size()) + " bytes are not one whole zstd frame");
    out.raw.assign(raw_bytes, 0);
    const std::size_t size = ZSTD_decompress(out.raw.data(), out.raw.size(), stored.data(), stored.size());
    if (ZSTD_isError(size) || size != raw_bytes) return refuse(": its zstd frame does not decode to " + std::to_string(raw_bytes) + " bytes");
    return {};
}

}  // namespace drtv
