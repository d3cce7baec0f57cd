// The parts of a mesh that bound a volume.
#pragma once

#include "bakerd/map/map.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace drtv::trace {

struct ClosedPart {
    bool outward = false;  // its fronts look away from what it bounds
    map::Bounds bounds;    // object space
};

// A part is what hangs together by edges. It is closed where each edge is passed as often one way as the
// other, so that winding numbers around it are whole; vertices at equal positions are one, and primitives of
// one mesh join. Only what is there everywhere (no alpha, no clear glass) bounds a volume.
class ClosedParts {
  public:
    static constexpr std::uint32_t none = UINT32_MAX;

    ClosedParts(const map::Map& map, const map::Mesh& mesh);

    [[nodiscard]] bool empty() const { return parts_.empty(); }
    [[nodiscard]] const ClosedPart& part(std::uint32_t n) const { return parts_[n]; }
    // Of a triangle of the mesh: its part, or none.
    [[nodiscard]] std::uint32_t part_of(std::uint32_t primitive, std::uint32_t triangle) const {
        return empty() ? none : part_of_[first_[primitive] + triangle];
    }

  private:
    std::vector<ClosedPart> parts_;       // in the order of their first triangles
    std::vector<std::size_t> first_;      // by primitive: its first triangle, counted over all
    std::vector<std::uint32_t> part_of_;  // by triangle; empty when there are no parts
};

}  // namespace drtv::trace
