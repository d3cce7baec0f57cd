// What must hold inside a section, so that all that reads it stays inside it. Messages are made on failure
// only.
#include "bytes.h"
#include "sections.h"

#include <drtv/sector.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace drtv {
namespace {

using Bytes = std::span<const std::uint8_t>;
using Local = layout::LocalTransferLayout;
using Rooms = layout::InteriorsLayout;

ReadStatus refuse(const Section& section, std::size_t at, std::string sentence) {
    return fail(ReadError::bad_section, section.place.at(at), std::move(sentence));
}

std::string number(std::int64_t value) {
    return std::to_string(value);
}

ReadStatus check_finite(const Section& section, std::size_t at, const char* sentence) {
    return std::isfinite(load_f32(section.raw, at)) ? ReadStatus{} : refuse(section, at, sentence);
}

ReadStatus check_bake(const Section& section) {
    if (ReadStatus status = check_finite(section, 8, "bake section: the reach is not finite"); !status.ok())
        return status;
    return check_finite(section, 12, "bake section: the minimal distance is not finite");
}

ReadStatus check_positions(const Section& section, std::size_t probe_count) {
    const Bytes raw = section.raw;
    for (std::size_t p = 0; p < probe_count; ++p) {
        const std::size_t at = p * layout::position_bytes;
        if (raw[at + 6] > static_cast<std::uint8_t>(ProbeKind::manual))
            return refuse(section,
                          at + 6,
                          "probe " + number(static_cast<std::int64_t>(p)) + ": kind " + number(raw[at + 6]) +
                              " is unknown");
        if (raw[at + 7] != 0)
            return refuse(section, at + 7, "probe " + std::to_string(p) + ": its reserved byte is not zero");
    }
    return {};
}

ReadStatus check_grid(const Section& section) {
    const std::int32_t z_origin = load_i32(section.raw, 0);
    const auto cell_height = load_le<std::uint32_t>(section.raw, 4);
    if (std::abs(std::int64_t{z_origin}) > max_z_origin_units)
        return refuse(
            section, 0, "grid section: z origin " + number(z_origin) + " is over the limit of 2^30");
    if (cell_height == 0 || cell_height > max_cell_height_units)
        return refuse(section,
                      4,
                      "grid section: the cell height " + number(cell_height) + " is not between 1 and 2^24");
    if (load_le<std::uint64_t>(section.raw, 8) != 0)
        return refuse(section, 8, "grid section: reserved bytes are not zero");
    return {};
}

// Afterwards all parts of the section lie inside it.
ReadStatus check_local_header(const Section& section, std::size_t probe_count) {
    const Bytes raw = section.raw;
    const std::size_t sources = load_le<std::uint16_t>(raw, Local::source_count),
                      mask_bytes = load_le<std::uint16_t>(raw, Local::mask_size);
    const std::size_t pairs = load_le<std::uint32_t>(raw, Local::pair_count);
    if (sources > max_probes)
        return refuse(
            section,
            Local::source_count,
            "local transfer section: " + std::to_string(sources) + " sources are over the limit of 255");
    if (mask_bytes != Local::mask_bytes(sources)) {
        return refuse(section,
                      Local::mask_size,
                      "local transfer section: masks of " + std::to_string(mask_bytes) +
                          " bytes, must be of " + std::to_string(Local::mask_bytes(sources)) + " for " +
                          std::to_string(sources) + " sources");
    }
    if (!all_zero(raw.subspan(Local::reserved, Local::header_bytes - Local::reserved))) {
        return refuse(
            section, Local::reserved, "local transfer section: reserved bytes of its header are not zero");
    }
    // The first half, so that no product overflows where size_t has 32 bits.
    if (const Local parts(probe_count, sources, pairs);
        pairs > probe_count * sources || parts.end != raw.size()) {
        return refuse(section,
                      Local::pair_count,
                      "local transfer section has " + std::to_string(raw.size()) + " bytes, must have " +
                          std::to_string(parts.end) + " for " + std::to_string(sources) + " sources and " +
                          std::to_string(pairs) + " pairs");
    }
    return {};
}

ReadStatus check_local_sources(const Section& section,
                               const Local& parts,
                               std::size_t source_count,
                               std::size_t probe_count) {
    const Bytes raw = section.raw;
    for (std::size_t s = 0; s < source_count; ++s) {
        const std::size_t at = Local::source_at(s);
        const auto di = static_cast<std::int8_t>(raw[at]), dj = static_cast<std::int8_t>(raw[at + 1]);
        if (std::abs(di) > 1 || std::abs(dj) > 1) {
            return refuse(section,
                          at,
                          "local source " + std::to_string(s) + " stands in the sector (" + number(di) +
                              ", " + number(dj) + ") away, which is not a neighbour");
        }
        // How many probes a neighbour has is not known here.
        const std::size_t probes = di == 0 && dj == 0 ? probe_count : max_probes;
        if (raw[at + 2] >= probes) {
            return refuse(section,
                          at + 2,
                          "local source " + std::to_string(s) + " is probe " + number(raw[at + 2]) +
                              ", its sector has at most " + std::to_string(probes));
        }
    }
    if (!all_zero(raw.subspan(parts.sources_end, parts.receivers - parts.sources_end))) {
        return refuse(
            section, parts.sources_end, "local transfer section: the padding behind the sources is not zero");
    }
    return {};
}

ReadStatus check_local_receivers(const Section& section,
                                 const Local& parts,
                                 std::size_t source_count,
                                 std::size_t probe_count) {
    const Bytes raw = section.raw;
    const std::size_t mask_bytes = Local::mask_bytes(source_count);
    std::size_t pairs = 0;
    for (std::size_t p = 0; p < probe_count; ++p) {
        const std::size_t at = parts.receiver_at(p), mask_at = parts.masks + p * mask_bytes;
        const auto name = [&] { return "local receiver " + std::to_string(p); };
        if (!all_zero(raw.subspan(at + 5, 3)))
            return refuse(section, at + 5, name() + ": its reserved bytes are not zero");
        if (const auto first = load_le<std::uint32_t>(raw, at); first != pairs) {
            return refuse(section,
                          at,
                          name() + " begins at pair " + number(first) + ", the masks before it have " +
                              std::to_string(pairs));
        }
        for (std::size_t word = 0; word < mask_bytes; word += sizeof(std::uint64_t)) {
            pairs += static_cast<std::size_t>(std::popcount(load_le<std::uint64_t>(raw, mask_at + word)));
        }
        for (std::size_t s = source_count; s < 8 * mask_bytes; ++s) {
            if (s % 8 == 0 && raw[mask_at + s / 8] == 0) {
                s += 7;
                continue;
            }
            if ((raw[mask_at + s / 8] >> (s % 8) & 1) == 0)
                continue;
            return refuse(section,
                          mask_at + s / 8,
                          name() + " has a pair with source " + std::to_string(s) + ", the sector has " +
                              std::to_string(source_count));
        }
    }
    if (!all_zero(raw.subspan(parts.receivers_end, parts.masks - parts.receivers_end))) {
        return refuse(section,
                      parts.receivers_end,
                      "local transfer section: the padding behind the receivers is not zero");
    }
    if (const auto said = load_le<std::uint32_t>(raw, Local::pair_count); said != pairs) {
        return refuse(section,
                      Local::pair_count,
                      "local transfer section: the header says " + number(said) + " pairs, the masks have " +
                          std::to_string(pairs));
    }
    return {};
}

ReadStatus check_local_transfer(const Section& section, std::size_t probe_count) {
    if (ReadStatus status = check_local_header(section, probe_count); !status.ok())
        return status;
    const std::size_t sources = load_le<std::uint16_t>(section.raw, Local::source_count);
    const Local parts(probe_count, sources, load_le<std::uint32_t>(section.raw, Local::pair_count));
    if (ReadStatus status = check_local_sources(section, parts, sources, probe_count); !status.ok())
        return status;
    return check_local_receivers(section, parts, sources, probe_count);
}

ReadStatus check_convergence(const Section& section) {
    for (std::size_t at = 0; at < 16; at += 4) {
        if (ReadStatus status = check_finite(section, at, "convergence section: an error is not finite");
            !status.ok())
            return status;
    }
    return {};
}

// Afterwards all parts of the section lie inside it.
ReadStatus check_interiors_header(const Section& section) {
    const Bytes raw = section.raw;
    const std::size_t count = load_le<std::uint16_t>(raw, Rooms::interior_count),
                      vertices = load_le<std::uint32_t>(raw, Rooms::vertex_count),
                      triangles = load_le<std::uint32_t>(raw, Rooms::triangle_count);
    if (count > max_interiors)
        return refuse(
            section,
            Rooms::interior_count,
            "interiors section: " + std::to_string(count) + " interiors are over the limit of 1024");
    if (load_le<std::uint16_t>(raw, Rooms::reserved) != 0 ||
        load_le<std::uint32_t>(raw, Rooms::reserved2) != 0) {
        return refuse(
            section, Rooms::reserved, "interiors section: reserved bytes of its header are not zero");
    }
    if (triangles > max_interior_triangles)
        return refuse(
            section,
            Rooms::triangle_count,
            "interiors section: " + std::to_string(triangles) + " triangles are over the limit of 2^18");
    // The first half, so that no product overflows where size_t has 32 bits.
    if (const Rooms parts(count, vertices, triangles); vertices > max_interiors_vertices ||
                                                       vertices > count * max_interior_vertices ||
                                                       parts.end != raw.size()) {
        return refuse(section,
                      Rooms::vertex_count,
                      "interiors section has " + std::to_string(raw.size()) + " bytes, must have " +
                          std::to_string(parts.end) + " for " + std::to_string(count) + " interiors, " +
                          std::to_string(vertices) + " vertices and " + std::to_string(triangles) +
                          " triangles");
    }
    return {};
}

ReadStatus check_interior(const Section& section,
                          const Rooms& parts,
                          std::size_t n,
                          std::size_t probe_count,
                          std::size_t& vertices,
                          std::size_t& triangles) {
    const Bytes raw = section.raw;
    const std::size_t at = Rooms::entry_at(n),
                      own_vertices = load_le<std::uint32_t>(raw, at + Rooms::vertices_of),
                      own_triangles = load_le<std::uint32_t>(raw, at + Rooms::triangles_of);
    const auto name = [&] { return "interior " + std::to_string(n); };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int32_t origin = load_i32(raw, at + Rooms::origin + 4 * axis);
        if (std::abs(std::int64_t{origin}) > max_interior_origin_units)
            return refuse(section,
                          at + 4 * axis,
                          name() + ": its origin " + number(origin) + " is over the limit of 2^30 + 2^27");
    }
    if (raw[at + Rooms::shift] > max_interior_shift)
        return refuse(section,
                      at + Rooms::shift,
                      name() + ": its shift " + number(raw[at + Rooms::shift]) + " is over the limit of 10");
    if (raw[at + Rooms::probe] >= probe_count) {
        return refuse(section,
                      at + Rooms::probe,
                      name() + " uses probe " + number(raw[at + Rooms::probe]) + ", the sector has " +
                          std::to_string(probe_count));
    }
    if (load_le<std::uint16_t>(raw, at + Rooms::entry_reserved) != 0)
        return refuse(section, at + Rooms::entry_reserved, name() + ": its reserved bytes are not zero");
    if (own_vertices > max_interior_vertices)
        return refuse(section,
                      at + Rooms::vertices_of,
                      name() + ": " + std::to_string(own_vertices) + " vertices are over the limit of 65536");
    if (const auto first = load_le<std::uint32_t>(raw, at + Rooms::first_vertex); first != vertices) {
        return refuse(section,
                      at + Rooms::first_vertex,
                      name() + " begins at vertex " + number(first) + ", those before it have " +
                          std::to_string(vertices));
    }
    if (const auto first = load_le<std::uint32_t>(raw, at + Rooms::first_triangle); first != triangles) {
        return refuse(section,
                      at + Rooms::first_triangle,
                      name() + " begins at triangle " + number(first) + ", those before it have " +
                          std::to_string(triangles));
    }
    vertices += own_vertices;
    if (own_triangles > load_le<std::uint32_t>(raw, Rooms::triangle_count) - triangles) {
        return refuse(
            section,
            at + Rooms::triangles_of,
            name() + " has " + std::to_string(own_triangles) + " triangles, more than the header leaves");
    }
    for (std::size_t t = 0; t < 3 * own_triangles; ++t) {
        const std::size_t index_at = parts.triangle_at(triangles) + 2 * t;
        const auto index = load_le<std::uint16_t>(raw, index_at);
        if (index >= own_vertices)
            return refuse(section,
                          index_at,
                          name() + ": triangle " + std::to_string(t / 3) + " has the vertex " +
                              number(index) + " of " + std::to_string(own_vertices));
    }
    triangles += own_triangles;
    return {};
}

ReadStatus check_interiors(const Section& section, std::size_t probe_count) {
    if (ReadStatus status = check_interiors_header(section); !status.ok())
        return status;
    const Bytes raw = section.raw;
    const std::size_t count = load_le<std::uint16_t>(raw, Rooms::interior_count);
    const Rooms parts(count,
                      load_le<std::uint32_t>(raw, Rooms::vertex_count),
                      load_le<std::uint32_t>(raw, Rooms::triangle_count));
    std::size_t vertices = 0, triangles = 0;
    for (std::size_t n = 0; n < count; ++n) {
        if (ReadStatus status = check_interior(section, parts, n, probe_count, vertices, triangles);
            !status.ok())
            return status;
    }
    if (const auto said = load_le<std::uint32_t>(raw, Rooms::vertex_count); said != vertices) {
        return refuse(section,
                      Rooms::vertex_count,
                      "interiors section: the header says " + number(said) +
                          " vertices, its interiors have " + std::to_string(vertices));
    }
    if (const auto said = load_le<std::uint32_t>(raw, Rooms::triangle_count); said != triangles) {
        return refuse(section,
                      Rooms::triangle_count,
                      "interiors section: the header says " + number(said) +
                          " triangles, its interiors have " + std::to_string(triangles));
    }
    if (!all_zero(raw.subspan(parts.vertices_end, parts.triangles - parts.vertices_end))) {
        return refuse(
            section, parts.vertices_end, "interiors section: the padding behind the vertices is not zero");
    }
    return {};
}

}  // namespace

ReadStatus check_content(SectionKind kind, const Section& section, std::size_t probe_count) {
    switch (kind) {
        case SectionKind::bake:
            return check_bake(section);
        case SectionKind::positions:
            return check_positions(section, probe_count);
        case SectionKind::grid:
            return check_grid(section);
        case SectionKind::statistics:
            return check_finite(section, 20, "statistics section: the used distance is not finite");
        case SectionKind::local_transfer:
            return check_local_transfer(section, probe_count);
        case SectionKind::convergence:
            return check_convergence(section);
        case SectionKind::interiors:
            return check_interiors(section, probe_count);
        case SectionKind::sky_visibility:
        case SectionKind::transfer:
        case SectionKind::static_irradiance:
            break;  // any codes can be read
    }
    return {};
}

}  // namespace drtv
