#include "codec.h"

#include "bytes.h"
#include "local_filter.h"
#include "section_refusal.h"

#include <zstd.h>

#include <utility>

namespace drtv {
namespace {

// High enough to be worth the time once, low enough to stay under a millisecond a sector. Local transfer is
// most of a file that has it: from level 15 on zstd gives each stretch of it its own statistics.
constexpr int zstd_level = 12;
constexpr int zstd_level_of_local_transfer = 15;

// One Zstandard frame, whole and alone: no skippable frame, none of a format before 0.8, nothing behind it.
bool is_one_frame(ByteSpan stored) {
    return stored.size() >= 4 && load_u32(stored, 0) == ZSTD_MAGICNUMBER &&
           ZSTD_findFrameCompressedSize(stored.data(), stored.size()) == stored.size();
}

// The frame's bytes; false where it has more than `out` holds, or is none. `out` is cut to what there was.
bool unpack_frame(ByteSpan stored, std::vector<std::uint8_t>& out) {
    const std::size_t size = ZSTD_decompress(out.data(), out.size(), stored.data(), stored.size());
    if (ZSTD_isError(size))
        return false;
    out.resize(size);
    return true;
}

}  // namespace

ReadStatus unpack_section(const PackedSection& packed, std::vector<std::uint8_t>& raw) {
    const ByteSpan stored = packed.stored;
    const std::size_t raw_bytes = packed.entry.raw_bytes;
    const bool filtered = static_cast<Codec>(packed.entry.codec) == Codec::filtered;
    if (!is_one_frame(stored))
        return refuse(packed.entry, ": its ", stored.size(), " bytes are not one whole zstd frame");
    raw.resize(filtered ? max_filtered_bytes(raw_bytes) : raw_bytes);
    const bool unpacked = unpack_frame(stored, raw);
    const bool right_size = filtered || raw.size() == raw_bytes;
    if (!unpacked || !right_size)
        return refuse(packed.entry, ": its zstd frame does not decode to ", raw_bytes, " bytes");
    if (!filtered)
        return {};
    const std::vector<std::uint8_t> planes = std::move(raw);
    if (unfilter_local(planes, packed.probe_count, packed.max_sources, raw_bytes, raw))
        return {};
    return refuse(packed.entry,
                  ": the ",
                  planes.size(),
                  " bytes of its zstd frame are not a filtered section of ",
                  raw_bytes,
                  " bytes");
}

std::vector<std::uint8_t> pack_section(ByteSpan raw, bool filtered, std::size_t probe_count) {
    const int level = filtered ? zstd_level_of_local_transfer : zstd_level;
    const ByteVector planes = filtered ? filter_local(raw, probe_count) : ByteVector();
    const ByteSpan bytes = filtered ? ByteSpan(planes) : raw;
    ByteVector packed(ZSTD_compressBound(bytes.size()));
    const std::size_t size = ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), level);
    const bool smaller = !ZSTD_isError(size) && size < raw.size();
    packed.resize(smaller ? size : 0);
    return packed;
}

}  // namespace drtv
