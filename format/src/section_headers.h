// The counts at the start of sections that have a header of their own: they tell where the parts behind it
// lie.
#pragma once

#include "bytes.h"
#include "layout.h"

#include <cstddef>

namespace drtv {

struct LocalTransferCounts {
    std::size_t sources;
    std::size_t pairs;

    [[nodiscard]] layout::LocalTransferLayout parts(std::size_t probe_count) const {
        return {probe_count, sources, pairs};
    }
};

// REQUIRES: the header's 16 bytes. What they say is not checked.
[[nodiscard]] inline LocalTransferCounts load_local_transfer_counts(ByteSpan section) {
    using Local = layout::LocalTransferLayout;
    return {load_u16(section, Local::source_count), load_u32(section, Local::pair_count)};
}

struct InteriorsCounts {
    std::size_t interiors;
    std::size_t vertices;
    std::size_t triangles;

    [[nodiscard]] layout::InteriorsLayout parts() const { return {interiors, vertices, triangles}; }
};

// REQUIRES: the header's 16 bytes. What they say is not checked.
[[nodiscard]] inline InteriorsCounts load_interiors_counts(ByteSpan section) {
    using Rooms = layout::InteriorsLayout;
    return {load_u16(section, Rooms::interior_count),
            load_u32(section, Rooms::vertex_count),
            load_u32(section, Rooms::triangle_count)};
}

}  // namespace drtv
