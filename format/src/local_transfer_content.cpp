#include "local_transfer_content.h"

#include "bytes.h"
#include "section_headers.h"
#include "section_refusal.h"

#include <drtv/sector.h>

#include <bit>
#include <cstdlib>

namespace drtv {
namespace {

using Local = layout::LocalTransferLayout;

// What the header says, beside the section.
struct LocalContent {
    const Section& section;
    ByteSpan raw;
    std::size_t probes;
    std::size_t sources;
    std::size_t pairs;
    std::size_t mask_bytes;
    Local parts;
};

LocalContent content_of(const Section& section, std::size_t probes) {
    const LocalTransferCounts counts = load_local_transfer_counts(section.raw);
    return {section,
            section.raw,
            probes,
            counts.sources,
            counts.pairs,
            local_mask_bytes(counts.sources),
            counts.parts(probes)};
}

ReadStatus check_padding(const LocalContent& content, std::size_t start, std::size_t end, const char* part) {
    if (all_zero(content.raw.subspan(start, end - start)))
        return {};
    return refuse(
        content.section, start, "local transfer section: the padding behind the ", part, " is not zero");
}

// Afterwards all parts of the section lie inside it.
ReadStatus check_local_header(const LocalContent& content) {
    const auto& [section, raw, probes, sources, pairs, mask_bytes, parts] = content;
    const std::size_t max_sources = Local::max_sources(section.version);
    if (sources > max_sources) {
        return refuse(section,
                      Local::source_count,
                      "local transfer section: ",
                      sources,
                      " sources are over the limit of ",
                      max_sources);
    }
    const auto said_mask_bytes = load_u16(raw, Local::mask_size);
    if (said_mask_bytes != mask_bytes) {
        return refuse(section,
                      Local::mask_size,
                      "local transfer section: masks of ",
                      said_mask_bytes,
                      " bytes, must be of ",
                      mask_bytes,
                      " for ",
                      sources,
                      " sources");
    }
    if (!all_zero(raw.subspan(Local::reserved, Local::header_bytes - Local::reserved))) {
        return refuse(
            section, Local::reserved, "local transfer section: reserved bytes of its header are not zero");
    }
    // The first half, so that no product overflows where size_t has 32 bits.
    if (pairs > probes * sources || parts.end != raw.size()) {
        return refuse(section,
                      Local::pair_count,
                      "local transfer section has ",
                      raw.size(),
                      " bytes, must have ",
                      parts.end,
                      " for ",
                      sources,
                      " sources and ",
                      pairs,
                      " pairs");
    }
    return {};
}

ReadStatus check_source(const LocalContent& content, std::size_t s) {
    const std::size_t at = Local::source_at(s);
    const std::int8_t di = load_i8(content.raw, at + Local::di);
    const std::int8_t dj = load_i8(content.raw, at + Local::dj);
    if (std::abs(di) > 1 || std::abs(dj) > 1) {
        return refuse(content.section,
                      at,
                      "local source ",
                      s,
                      " stands in the sector (",
                      di,
                      ", ",
                      dj,
                      ") away, which is not a neighbour");
    }
    // How many probes a neighbour has is not known here.
    const bool own = di == 0 && dj == 0;
    const std::size_t probes = own ? content.probes : max_probes;
    const std::uint8_t probe = content.raw[at + Local::probe];
    if (probe < probes)
        return {};
    return refuse(content.section,
                  at + Local::probe,
                  "local source ",
                  s,
                  " is probe ",
                  probe,
                  ", its sector has at most ",
                  probes);
}

ReadStatus check_sources(const LocalContent& content) {
    for (std::size_t s = 0; s < content.sources; ++s) {
        if (ReadStatus status = check_source(content, s); !status.ok())
            return status;
    }
    return check_padding(content, content.parts.sources_end, content.parts.receivers, "sources");
}

std::size_t count_bits(ByteSpan mask) {
    int count = 0;
    for (std::size_t at = 0; at < mask.size(); at += sizeof(std::uint64_t))
        count += std::popcount(load_u64(mask, at));
    return static_cast<std::size_t>(count);
}

// The first bit that is set from `start` on; the number of bits where there is none.
std::size_t find_bit(ByteSpan mask, std::size_t start) {
    std::size_t below = start % 8;  // bits of the first byte that do not count
    for (std::size_t n = start / 8; n < mask.size(); ++n) {
        const unsigned bits = unsigned{mask[n]} >> below << below;
        if (bits != 0)
            return 8 * n + static_cast<std::size_t>(std::countr_zero(bits));
        below = 0;
    }
    return 8 * mask.size();
}

// Adds the receiver's pairs to `pairs`, which is the number of those before it.
ReadStatus check_receiver(const LocalContent& content, std::size_t p, std::size_t& pairs) {
    const auto& [section, raw, probes, sources, said_pairs, mask_bytes, parts] = content;
    const std::size_t at = parts.receiver_at(p);
    const std::size_t reserved_at = at + Local::receiver_reserved;
    if (!all_zero(raw.subspan(reserved_at, Local::receiver_bytes - Local::receiver_reserved)))
        return refuse(section, reserved_at, "local receiver ", p, ": its reserved bytes are not zero");
    const auto first_pair = load_u32(raw, at + Local::first_pair);
    if (first_pair != pairs) {
        return refuse(section,
                      at,
                      "local receiver ",
                      p,
                      " begins at pair ",
                      first_pair,
                      ", the masks before it have ",
                      pairs);
    }
    const std::size_t mask_at = parts.masks + p * mask_bytes;
    const ByteSpan mask = raw.subspan(mask_at, mask_bytes);
    pairs += count_bits(mask);
    const std::size_t beyond = find_bit(mask, sources);
    if (beyond == 8 * mask_bytes)
        return {};
    return refuse(section,
                  mask_at + beyond / 8,
                  "local receiver ",
                  p,
                  " has a pair with source ",
                  beyond,
                  ", the sector has ",
                  sources);
}

ReadStatus check_receivers(const LocalContent& content) {
    std::size_t pairs = 0;
    for (std::size_t p = 0; p < content.probes; ++p) {
        if (ReadStatus status = check_receiver(content, p, pairs); !status.ok())
            return status;
    }
    const Local& parts = content.parts;
    if (ReadStatus status = check_padding(content, parts.receivers_end, parts.masks, "receivers");
        !status.ok())
        return status;
    if (content.pairs == pairs)
        return {};
    return refuse(content.section,
                  Local::pair_count,
                  "local transfer section: the header says ",
                  content.pairs,
                  " pairs, the masks have ",
                  pairs);
}

}  // namespace

ReadStatus check_local_transfer_content(const Section& section, std::size_t probe_count) {
    const LocalContent content = content_of(section, probe_count);
    if (ReadStatus status = check_local_header(content); !status.ok())
        return status;
    if (ReadStatus status = check_sources(content); !status.ok())
        return status;
    return check_receivers(content);
}

}  // namespace drtv
