// Which triangles of a mesh hang together by edges, and which of these parts are closed. Closed parts that
// share an edge only touch.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace drtv::placement {

// Vertices at equal positions as one: glTF splits them by normal.
struct MergedVertices {
    std::vector<glm::dvec3> positions;
    std::vector<std::uint32_t> number;  // of each vertex: its position
};
[[nodiscard]] MergedVertices merge_vertices(std::span<const glm::dvec3> vertices);

// A triangle's way along one of its edges.
struct HalfEdge {
    std::uint32_t low;  // vertices, the smaller number first
    std::uint32_t high;
    std::uint32_t triangle;
    bool rising;  // from low to high
};

[[nodiscard]] bool has_three_corners(const glm::uvec3& triangle);

// Of all triangles with three different corners, sorted by their vertices.
[[nodiscard]] std::vector<HalfEdge> half_edges(std::span<const glm::uvec3> triangles);

// Calls visit(half-edges of one edge) for each edge. REQUIRES: they are sorted.
template <class Visit>
void visit_edges(std::span<const HalfEdge> half_edges, Visit visit) {
    for (std::size_t n = 0; n < half_edges.size();) {
        const HalfEdge& first = half_edges[n];
        std::size_t end = n;
        while (end < half_edges.size() && half_edges[end].low == first.low &&
               half_edges[end].high == first.high)
            ++end;
        visit(half_edges.subspan(n, end - n));
        n = end;
    }
}

inline constexpr std::uint32_t no_part = UINT32_MAX;

struct MeshParts {
    std::vector<std::uint32_t> part_of;  // by triangle; no_part of one with two equal corners
    // By part, in the order of their first triangles: it passes each edge as often one way as the other, so
    // that winding numbers around it are whole.
    std::vector<bool> closed;
};
[[nodiscard]] MeshParts parts_by_edges(std::span<const glm::uvec3> triangles,
                                       std::span<const HalfEdge> half_edges);

}  // namespace drtv::placement
