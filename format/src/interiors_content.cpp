#include "interiors_content.h"

#include "bytes.h"
#include "section_headers.h"
#include "section_refusal.h"

#include <drtv/sector.h>

#include <cstdlib>

namespace drtv {
namespace {

using Rooms = layout::InteriorsLayout;

// What the header says, beside the section.
struct InteriorsContent {
    const Section& section;
    ByteSpan raw;
    std::size_t interiors;
    std::size_t vertices;
    std::size_t triangles;
    Rooms parts;
};

InteriorsContent content_of(const Section& section) {
    const InteriorsCounts counts = load_interiors_counts(section.raw);
    return {section, section.raw, counts.interiors, counts.vertices, counts.triangles, counts.parts()};
}

// One interior's line of the table.
struct Entry {
    std::uint8_t shift;
    std::uint8_t probe;
    std::uint16_t reserved;
    std::uint32_t first_vertex;
    std::size_t vertices;
    std::uint32_t first_triangle;
    std::size_t triangles;
};

Entry load_entry(ByteSpan raw, std::size_t at) {
    return {raw[at + Rooms::shift],
            raw[at + Rooms::probe],
            load_u16(raw, at + Rooms::entry_reserved),
            load_u32(raw, at + Rooms::first_vertex),
            load_u32(raw, at + Rooms::vertices_of),
            load_u32(raw, at + Rooms::first_triangle),
            load_u32(raw, at + Rooms::triangles_of)};
}

// What the interiors before one have together.
struct Before {
    std::size_t vertices = 0;
    std::size_t triangles = 0;
};

template <class... Parts>
ReadStatus refuse_interior(const InteriorsContent& content,
                           std::size_t n,
                           std::size_t field,
                           const Parts&... parts) {
    return refuse(content.section, Rooms::entry_at(n) + field, "interior ", n, parts...);
}

// Afterwards all parts of the section lie inside it.
ReadStatus check_interiors_header(const InteriorsContent& content) {
    const auto& [section, raw, interiors, vertices, triangles, parts] = content;
    if (interiors > max_interiors) {
        return refuse(section,
                      Rooms::interior_count,
                      "interiors section: ",
                      interiors,
                      " interiors are over the limit of 1024");
    }
    const auto reserved = load_u16(raw, Rooms::reserved);
    const auto reserved2 = load_u32(raw, Rooms::reserved2);
    if (reserved != 0 || reserved2 != 0) {
        return refuse(
            section, Rooms::reserved, "interiors section: reserved bytes of its header are not zero");
    }
    if (triangles > max_interior_triangles) {
        return refuse(section,
                      Rooms::triangle_count,
                      "interiors section: ",
                      triangles,
                      " triangles are over the limit of 2^18");
    }
    // The first two, so that no product overflows where size_t has 32 bits.
    if (vertices > max_interiors_vertices || vertices > interiors * max_interior_vertices ||
        parts.end != raw.size()) {
        return refuse(section,
                      Rooms::vertex_count,
                      "interiors section has ",
                      raw.size(),
                      " bytes, must have ",
                      parts.end,
                      " for ",
                      interiors,
                      " interiors, ",
                      vertices,
                      " vertices and ",
                      triangles,
                      " triangles");
    }
    return {};
}

// Where the interior lies, and by which probe it is lit.
ReadStatus check_place(const InteriorsContent& content,
                       std::size_t n,
                       const Entry& entry,
                       std::size_t probe_count) {
    const std::size_t at = Rooms::entry_at(n);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t field = Rooms::origin + 4 * axis;
        const std::int64_t origin = load_i32(content.raw, at + field);
        if (std::abs(origin) > max_interior_origin_units) {
            return refuse_interior(
                content, n, field, ": its origin ", origin, " is over the limit of 2^30 + 2^27");
        }
    }
    if (entry.shift > max_interior_shift) {
        return refuse_interior(
            content, n, Rooms::shift, ": its shift ", entry.shift, " is over the limit of 10");
    }
    if (entry.probe >= probe_count) {
        return refuse_interior(
            content, n, Rooms::probe, " uses probe ", entry.probe, ", the sector has ", probe_count);
    }
    if (entry.reserved != 0)
        return refuse_interior(content, n, Rooms::entry_reserved, ": its reserved bytes are not zero");
    return {};
}

// Which vertices and triangles are the interior's.
ReadStatus check_ranges(const InteriorsContent& content,
                        std::size_t n,
                        const Entry& entry,
                        const Before& before) {
    if (entry.vertices > max_interior_vertices) {
        return refuse_interior(
            content, n, Rooms::vertices_of, ": ", entry.vertices, " vertices are over the limit of 65536");
    }
    if (entry.first_vertex != before.vertices) {
        return refuse_interior(content,
                               n,
                               Rooms::first_vertex,
                               " begins at vertex ",
                               entry.first_vertex,
                               ", those before it have ",
                               before.vertices);
    }
    if (entry.first_triangle != before.triangles) {
        return refuse_interior(content,
                               n,
                               Rooms::first_triangle,
                               " begins at triangle ",
                               entry.first_triangle,
                               ", those before it have ",
                               before.triangles);
    }
    if (entry.triangles > content.triangles - before.triangles) {
        return refuse_interior(content,
                               n,
                               Rooms::triangles_of,
                               " has ",
                               entry.triangles,
                               " triangles, more than the header leaves");
    }
    return {};
}

ReadStatus check_triangles(const InteriorsContent& content, std::size_t n, const Entry& entry) {
    const std::size_t start = content.parts.triangle_at(entry.first_triangle);
    for (std::size_t corner = 0; corner < 3 * entry.triangles; ++corner) {
        const std::size_t at = start + 2 * corner;
        const auto vertex = load_u16(content.raw, at);
        if (vertex < entry.vertices)
            continue;
        return refuse(content.section,
                      at,
                      "interior ",
                      n,
                      ": triangle ",
                      corner / 3,
                      " has the vertex ",
                      vertex,
                      " of ",
                      entry.vertices);
    }
    return {};
}

ReadStatus check_interiors(const InteriorsContent& content, std::size_t probe_count, Before& before) {
    for (std::size_t n = 0; n < content.interiors; ++n) {
        const Entry entry = load_entry(content.raw, Rooms::entry_at(n));
        if (ReadStatus status = check_place(content, n, entry, probe_count); !status.ok())
            return status;
        if (ReadStatus status = check_ranges(content, n, entry, before); !status.ok())
            return status;
        if (ReadStatus status = check_triangles(content, n, entry); !status.ok())
            return status;
        before.vertices += entry.vertices;
        before.triangles += entry.triangles;
    }
    return {};
}

ReadStatus check_total(
    const Section& section, std::size_t at, std::size_t said, std::size_t total, const char* what) {
    if (said == total)
        return {};
    return refuse(
        section, at, "interiors section: the header says ", said, " ", what, ", its interiors have ", total);
}

}  // namespace

ReadStatus check_interiors_content(const Section& section, std::size_t probe_count) {
    const InteriorsContent content = content_of(section);
    if (ReadStatus status = check_interiors_header(content); !status.ok())
        return status;
    Before all;
    if (ReadStatus status = check_interiors(content, probe_count, all); !status.ok())
        return status;
    ReadStatus status = check_total(section, Rooms::vertex_count, content.vertices, all.vertices, "vertices");
    if (status.ok())
        status = check_total(section, Rooms::triangle_count, content.triangles, all.triangles, "triangles");
    if (!status.ok())
        return status;
    const Rooms& parts = content.parts;
    const ByteSpan padding = content.raw.subspan(parts.vertices_end, parts.triangles - parts.vertices_end);
    if (!all_zero(padding)) {
        return refuse(
            section, parts.vertices_end, "interiors section: the padding behind the vertices is not zero");
    }
    return {};
}

}  // namespace drtv
