#include "placement/mesh_parts.h"

#include "placement/disjoint_sets.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <tuple>
#include <utility>

namespace drtv::placement {
bool has_three_corners(const glm::uvec3& t) {
    return t.x != t.y && t.y != t.z && t.z != t.x;
}

MergedVertices merge_vertices(std::span<const glm::dvec3> vertices) {
    struct Vertex {
        glm::dvec3 position;
        std::uint32_t index;
    };
    std::vector<Vertex> sorted;
    sorted.reserve(vertices.size());
    for (const glm::dvec3& position : vertices)
        sorted.push_back({position + 0.0, static_cast<std::uint32_t>(sorted.size())});  // -0 becomes 0
    const auto place = [](const Vertex& v) { return std::tie(v.position.x, v.position.y, v.position.z); };
    std::ranges::sort(sorted, [&](const Vertex& a, const Vertex& b) { return place(a) < place(b); });
    MergedVertices merged;
    merged.number.resize(vertices.size());
    for (std::size_t n = 0; n < sorted.size(); ++n) {
        if (n == 0 || place(sorted[n - 1]) != place(sorted[n]))
            merged.positions.push_back(sorted[n].position);
        merged.number[sorted[n].index] = static_cast<std::uint32_t>(merged.positions.size() - 1);
    }
    return merged;
}

std::vector<HalfEdge> half_edges(std::span<const glm::uvec3> triangles) {
    std::vector<HalfEdge> edges;
    edges.reserve(3 * triangles.size());
    for (std::uint32_t n = 0; n < triangles.size(); ++n) {
        const glm::uvec3& t = triangles[n];
        if (!has_three_corners(t))
            continue;
        for (glm::length_t k = 0; k < 3; ++k) {
            const std::uint32_t from = t[k];
            const std::uint32_t to = t[(k + 1) % 3];
            edges.push_back({std::min(from, to), std::max(from, to), n, from < to});
        }
    }
    std::ranges::sort(edges, {}, [](const HalfEdge& e) { return std::tuple(e.low, e.high, e.triangle); });
    return edges;
}

MeshParts parts_by_edges(std::span<const glm::uvec3> triangles, std::span<const HalfEdge> half_edges) {
    DisjointSets sets(triangles.size());
    visit_edges(half_edges, [&](std::span<const HalfEdge> edge) {
        if (edge.size() == 2)
            sets.join(edge[0].triangle, edge[1].triangle);
    });
    // Where more meet, parts that are balanced there by themselves only touch each other.
    std::vector<std::uint32_t> at_open_edges;
    for (const bool closing : {false, true}) {
        visit_edges(half_edges, [&](std::span<const HalfEdge> edge) {
            if (edge.size() == 2 && !closing)
                return;
            std::map<std::uint32_t, std::int64_t> balances;  // by part
            for (const HalfEdge& half : edge)
                balances[sets.root_of(half.triangle)] += half.rising ? 1 : -1;
            std::erase_if(balances, [](const auto& entry) { return entry.second == 0; });
            for (const auto& [part, balance] : balances) {
                if (closing)
                    at_open_edges.push_back(part);
                else
                    sets.join(balances.begin()->first, part);
            }
        });
    }
    MeshParts parts;
    parts.part_of.resize(triangles.size(), no_part);
    for (std::uint32_t n = 0; n < triangles.size(); ++n) {
        if (!has_three_corners(triangles[n]))
            continue;
        const std::uint32_t root = sets.root_of(n);  // comes first in its part
        if (root == n) {
            parts.part_of[n] = static_cast<std::uint32_t>(parts.closed.size());
            parts.closed.push_back(true);
        }
        parts.part_of[n] = parts.part_of[root];
    }
    for (const std::uint32_t triangle : at_open_edges)
        parts.closed[parts.part_of[triangle]] = false;
    return parts;
}

}  // namespace drtv::placement
