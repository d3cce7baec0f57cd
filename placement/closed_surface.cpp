#include "placement/closed_surface.h"

#include "placement/mesh_parts.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace drtv::placement {
namespace {

void turn(glm::uvec3& triangle) {
    std::swap(triangle.y, triangle.z);
}

// A triangle beside another one, over an edge that only these two have.
struct Neighbour {
    std::uint32_t triangle;
    bool alike;  // both pass the edge the same way: one of them is turned
};
using Neighbours = std::vector<std::array<Neighbour, 3>>;

// Turns the triangles of the parts that are not closed as they are wound, each like the part's first.
class Turning {
  public:
    Turning(std::vector<glm::uvec3>& triangles, const MeshParts& parts, std::span<const HalfEdge> half_edges)
        : triangles_(triangles), parts_(parts), half_edges_(half_edges) {}

    tl::expected<void, std::string> run() {
        if (auto found = find_neighbours(); !found)
            return found;
        std::vector<State> states(triangles_.size(), State::unknown);
        for (std::uint32_t n = 0; n < triangles_.size(); ++n) {
            if (parts_.closed[parts_.part_of[n]] || states[n] != State::unknown)
                continue;
            if (!turn_part(n, states))
                return tl::unexpected(
                    std::string("has no inside, as a Klein bottle has none: make it of closed parts"));
        }
        for (std::uint32_t n = 0; n < triangles_.size(); ++n) {
            if (states[n] == State::turned)
                turn(triangles_[n]);
        }
        return {};
    }

  private:
    enum class State : std::uint8_t { unknown, right, turned };

    tl::expected<void, std::string> find_neighbours() {
        std::string problem;
        neighbours_.resize(triangles_.size());
        std::vector<std::size_t> counts(triangles_.size(), 0);
        visit_edges(half_edges_, [&](std::span<const HalfEdge> edge) {
            if (std::ranges::all_of(
                    edge, [&](const HalfEdge& half) { return parts_.closed[parts_.part_of[half.triangle]]; }))
                return;
            if (edge.size() > 2)
                problem =
                    "has an edge that belongs to three triangles or more: remove its inner faces, or make it "
                    "of closed parts";
            else if (edge.size() == 1 && problem.empty())
                problem = "is open, so inside and outside cannot be told apart: close its holes";
            if (edge.size() != 2)
                return;
            const bool alike = edge[0].rising == edge[1].rising;
            const std::uint32_t a = edge[0].triangle;
            const std::uint32_t b = edge[1].triangle;
            neighbours_[a][counts[a]++] = {b, alike};
            neighbours_[b][counts[b]++] = {a, alike};
        });
        return problem.empty() ? tl::expected<void, std::string>{} : tl::unexpected(std::move(problem));
    }

    // False where a way around it comes back turned.
    [[nodiscard]] bool turn_part(std::uint32_t first, std::vector<State>& states) const {
        std::vector<std::uint32_t> waiting = {first};
        states[first] = State::right;
        while (!waiting.empty()) {
            const std::uint32_t n = waiting.back();
            waiting.pop_back();
            for (const auto& [other, alike] : neighbours_[n]) {
                const State wanted = (states[n] == State::right) == alike ? State::turned : State::right;
                if (states[other] == State::unknown) {
                    states[other] = wanted;
                    waiting.push_back(other);
                } else if (states[other] != wanted) {
                    return false;
                }
            }
        }
        return true;
    }

    std::vector<glm::uvec3>& triangles_;
    const MeshParts& parts_;
    const std::span<const HalfEdge> half_edges_;
    Neighbours neighbours_;
};

// Leaves out parts that bound nothing, as the wall does that two boxes share.
void turn_outwards(ClosedSurface& surface, const MeshParts& parts) {
    constexpr double rounding = 1e-12;  // of the parts' cubes
    std::vector<double> six_volumes(parts.closed.size(), 0);
    std::vector<double> sides(parts.closed.size(), 0);
    std::vector<const glm::dvec3*> from(parts.closed.size(), nullptr);  // a corner of the part's own
    const auto& [vertices, triangles] = surface;
    for (std::size_t n = 0; n < triangles.size(); ++n) {
        const std::uint32_t part = parts.part_of[n];
        const glm::uvec3& t = triangles[n];
        if (from[part] == nullptr)
            from[part] = &vertices[t.x];
        const glm::dvec3& o = *from[part];
        sides[part] = std::max({sides[part],
                                glm::distance(o, vertices[t.x]),
                                glm::distance(o, vertices[t.y]),
                                glm::distance(o, vertices[t.z])});
        six_volumes[part] += glm::dot(vertices[t.x] - o, glm::cross(vertices[t.y] - o, vertices[t.z] - o));
    }
    std::vector<glm::uvec3> turned;
    for (std::size_t n = 0; n < triangles.size(); ++n) {
        const std::uint32_t part = parts.part_of[n];
        if (std::abs(six_volumes[part]) <= rounding * sides[part] * sides[part] * sides[part])
            continue;
        turned.push_back(triangles[n]);
        if (six_volumes[part] < 0)
            turn(turned.back());
    }
    surface.triangles = std::move(turned);
}

}  // namespace

tl::expected<ClosedSurface, std::string> closed_surface(std::span<const glm::dvec3> positions,
                                                        std::span<const glm::uvec3> triangles) {
    MergedVertices merged = merge_vertices(positions);
    ClosedSurface surface;
    for (const glm::uvec3& t : triangles) {
        const glm::uvec3 corners(merged.number[t.x], merged.number[t.y], merged.number[t.z]);
        if (has_three_corners(corners))
            surface.triangles.push_back(corners);
    }
    if (surface.triangles.empty())
        return tl::unexpected(std::string("has no triangles"));
    surface.vertices = std::move(merged.positions);
    const std::vector<HalfEdge> edges = half_edges(surface.triangles);
    const MeshParts parts = parts_by_edges(surface.triangles, edges);
    if (std::ranges::count(parts.closed, false) > 0) {
        if (auto turned = Turning(surface.triangles, parts, edges).run(); !turned)
            return tl::unexpected(turned.error());
    }
    turn_outwards(surface, parts);
    if (surface.triangles.empty())
        return tl::unexpected(
            std::string("bounds no volume: its faces lie on each other, turned apart; give it a thickness"));
    return surface;
}

}  // namespace drtv::placement
