#include "read_light.h"

#include "bytes.h"
#include "decode_section.h"
#include "layout.h"

#include <bit>
#include <cmath>
#include <cstdlib>

namespace drtv {
namespace {

using Bytes = std::span<const std::uint8_t>;
using Local = layout::LocalTransferLayout;

ReadStatus refuse(std::uint64_t offset, const std::string& sentence) { return fail(ReadError::bad_section, offset, sentence); }

void read_static_irradiance(Bytes raw, std::vector<StaticIrradiance>& probes) {
    std::size_t at = 0;
    for (StaticIrradiance& probe : probes) at = load_codes(raw, at, probe.codes);
    for (StaticIrradiance& probe : probes) probe.exponent = static_cast<std::int8_t>(raw[at++]);
}

// Afterwards all parts of the section lie inside it. REQUIRES: section.raw.size() >= Local::header_bytes.
ReadStatus check_local_header(const DecodedSection& section, std::size_t probe_count) {
    const Bytes raw = section.raw;
    const std::size_t sources = load_le<std::uint16_t>(raw, Local::source_count), mask_bytes = load_le<std::uint16_t>(raw, Local::mask_size);
    const std::size_t pairs = load_le<std::uint32_t>(raw, Local::pair_count);
    const layout::Place& place = section.place;
    if (sources > max_probes) {
        return refuse(place.at(Local::source_count), "local transfer section: " + std::to_string(sources) + " sources are over the limit of 255");
    }
    if (mask_bytes != Local::mask_bytes(sources)) {
        return refuse(place.at(Local::mask_size), "local transfer section: masks of " + std::to_string(mask_bytes) + " bytes, must be of " +
                                                      std::to_string(Local::mask_bytes(sources)) + " for " + std::to_string(sources) + " sources");
    }
    if (!all_zero(raw.subspan(Local::reserved, Local::header_bytes - Local::reserved))) {
        return refuse(place.at(Local::reserved), "local transfer section: reserved bytes of its header are not zero");
    }
    // The first half, so that no product overflows where size_t has 32 bits.
    if (const Local parts(probe_count, sources, pairs); pairs > probe_count * sources || parts.end != raw.size()) {
        return refuse(place.at(Local::pair_count), "local transfer section has " + std::to_string(raw.size()) + " bytes, must have " +
                                                       std::to_string(parts.end) + " for " + std::to_string(sources) + " sources and " +
                                                       std::to_string(pairs) + " pairs");
    }
    return {};
}

ReadStatus read_local_sources(const DecodedSection& section, const Local& parts, std::size_t probe_count, std::vector<LocalSource>& sources) {
    const Bytes raw = section.raw;
    for (std::size_t s = 0; s < sources.size(); ++s) {
        const std::size_t at = Local::source_at(s);
        const LocalSource source = {static_cast<std::int8_t>(raw[at]), static_cast<std::int8_t>(raw[at + 1]), raw[at + 2],
                                    static_cast<std::int8_t>(raw[at + 3])};
        const std::string name = "local source " + std::to_string(s);
        if (std::abs(source.di) > 1 || std::abs(source.dj) > 1) {
            return refuse(section.place.at(at), name + " stands in the sector (" + std::to_string(source.di) + ", " + std::to_string(source.dj) +
                                                    ") away, which is not a neighbour");
        }
        // How many probes a neighbour has is not known here.
        const std::size_t probes = source.di == 0 && source.dj == 0 ? probe_count : max_probes;
        if (source.probe >= probes) {
            return refuse(section.place.at(at + 2), name + " is probe " + std::to_string(source.probe) + ", its sector has at most " + std::to_string(probes));
        }
        sources[s] = source;
    }
    if (!all_zero(raw.subspan(parts.sources_end, parts.receivers - parts.sources_end))) {
        return refuse(section.place.at(parts.sources_end), "local transfer section: the padding behind the sources is not zero");
    }
    return {};
}

ReadStatus read_local_receivers(const DecodedSection& section, const Local& parts, LocalTransfer& local) {
    const Bytes raw = section.raw;
    const std::size_t mask_bytes = Local::mask_bytes(local.sources.size());
    std::size_t pairs = 0;
    for (std::size_t p = 0; p < local.receivers.size(); ++p) {
        LocalReceiver& receiver = local.receivers[p];
        const std::size_t at = parts.receiver_at(p), mask_at = parts.masks + p * mask_bytes;
        const std::string name = "local receiver " + std::to_string(p);
        receiver.first_pair = load_le<std::uint32_t>(raw, at);
        receiver.exponent = static_cast<std::int8_t>(raw[at + 4]);
        if (!all_zero(raw.subspan(at + 5, 3))) return refuse(section.place.at(at + 5), name + ": its reserved bytes are not zero");
        if (receiver.first_pair != pairs) {
            return refuse(section.place.at(at), name + " begins at pair " + std::to_string(receiver.first_pair) + ", the masks before it have " + std::to_string(pairs));
        }
        for (std::size_t k = 0; k < mask_bytes; ++k) {
            receiver.sources[k] = raw[mask_at + k];
            pairs += static_cast<std::size_t>(std::popcount(receiver.sources[k]));
        }
        for (std::size_t s = local.sources.size(); s < 8 * mask_bytes; ++s) {
            if (!has_pair(receiver, s)) continue;
            return refuse(section.place.at(mask_at + s / 8), name + " has a pair with source " + std::to_string(s) + ", the sector has " +
                                                                 std::to_string(local.sources.size()));
        }
    }
    if (!all_zero(raw.subspan(parts.receivers_end, parts.masks - parts.receivers_end))) {
        return refuse(section.place.at(parts.receivers_end), "local transfer section: the padding behind the receivers is not zero");
    }
    if (pairs != local.pairs.size()) {
        return refuse(section.place.at(Local::pair_count), "local transfer section: the header says " + std::to_string(local.pairs.size()) +
                                                               " pairs, the masks have " + std::to_string(pairs));
    }
    return {};
}

ReadStatus read_local_transfer(const DecodedSection& section, std::size_t probe_count, LocalTransfer& local) {
    const Bytes raw = section.raw;
    if (ReadStatus status = check_local_header(section, probe_count); !status.ok()) return status;
    local.sources.resize(load_le<std::uint16_t>(raw, Local::source_count));
    local.receivers.resize(probe_count);
    local.pairs.resize(load_le<std::uint32_t>(raw, Local::pair_count));
    const Local parts(probe_count, local.sources.size(), local.pairs.size());
    if (ReadStatus status = read_local_sources(section, parts, probe_count, local.sources); !status.ok()) return status;
    if (ReadStatus status = read_local_receivers(section, parts, local); !status.ok()) return status;
    std::size_t at = parts.codes;
    for (LightCodes& pair : local.pairs) at = load_codes(raw, at, pair);
    return {};
}

ReadStatus read_convergence(const DecodedSection& section, Convergence& c) {
    const Bytes raw = section.raw;
    std::size_t at = 0;
    for (float* error : {&c.error_asked, &c.error_median, &c.error_p95, &c.error_max}) {
        *error = load_f32(raw, at);
        if (!std::isfinite(*error)) return refuse(section.place.at(at), "convergence section: an error is not finite");
        at += 4;
    }
    for (std::uint32_t* count : {&c.paths_least, &c.paths_most, &c.local_bounces, &c.local_rays}) {
        *count = load_le<std::uint32_t>(raw, at);
        at += 4;
    }
    c.static_rays = load_le<std::uint64_t>(raw, at);
    c.local_transfer_rays = load_le<std::uint64_t>(raw, at + 8);
    return {};
}

// The one section whose length is not known before it is decoded.
ReadStatus decode_local_transfer(Bytes file, const SectionEntry& entry, std::size_t probe_count, DecodedSection& out) {
    const std::size_t most = Local(probe_count, max_probes, probe_count * max_probes).end;
    if (entry.raw_bytes < Local::header_bytes || entry.raw_bytes > most) {
        return refuse(entry.offset, section_name(entry) + " has " + std::to_string(entry.raw_bytes) + " bytes, must have " +
                                        std::to_string(Local::header_bytes) + " to " + std::to_string(most));
    }
    return decode_section(file, entry, entry.raw_bytes, out);
}

}  // namespace

ReadStatus read_light_sections(Bytes file, std::span<const SectionEntry> entries, Sector& sector) {
    if (load_le<std::uint16_t>(file, layout::header::minor) < layout::minor_with_light_sections) return {};
    const std::size_t count = sector.probes.size();
    DecodedSection section;
    const auto find = [&](SectionKind kind) {
        const SectionEntry* entry = find_section(entries, kind);
        return entry != nullptr && entry->version == 1 ? entry : nullptr;
    };
    if (const SectionEntry* entry = find(SectionKind::static_irradiance)) {
        if (ReadStatus status = decode_section(file, *entry, count * layout::static_irradiance_bytes, section); !status.ok()) return status;
        sector.static_irradiance.resize(count);
        read_static_irradiance(section.raw, sector.static_irradiance);
    }
    if (const SectionEntry* entry = find(SectionKind::local_transfer)) {
        if (ReadStatus status = decode_local_transfer(file, *entry, count, section); !status.ok()) return status;
        if (ReadStatus status = read_local_transfer(section, count, sector.local_transfer.emplace()); !status.ok()) return status;
    }
    if (const SectionEntry* entry = find(SectionKind::convergence)) {
        if (ReadStatus status = decode_section(file, *entry, layout::convergence_bytes, section); !status.ok()) return status;
        if (ReadStatus status = read_convergence(section, sector.convergence.emplace()); !status.ok()) return status;
    }
    return {};
}

}  // namespace drtv
