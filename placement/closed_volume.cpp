#include "placement/closed_volume.h"

#include "placement/closed_surface.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/enum.h>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace drtv::placement {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 point_of(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

// Of a triangle's plan, on which side of an edge the point lies: 1 left, -1 right. A point exactly on it
// counts as moved by an infinitesimal step east and a smaller one north (simulation of simplicity,
// Edelsbrunner and Mücke 1990), so that one of the two triangles at an edge holds it; 0 for an edge without
// extent.
int side_of_edge(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& p) {
    const int side =
        CGAL::orientation(Kernel::Point_2(a.x, a.y), Kernel::Point_2(b.x, b.y), Kernel::Point_2(p.x, p.y));
    if (side != 0)
        return side;
    if (a.y != b.y)
        return a.y > b.y ? 1 : -1;
    if (a.x != b.x)
        return b.x > a.x ? 1 : -1;
    return 0;
}

bool is_on(const Kernel::Triangle_3& triangle, const glm::dvec3& p) {
    return !triangle.is_degenerate() && triangle.has_on(point_of(p));
}

// The bounds of a triangle, or of a square of the plan at all heights.
bool overlaps(const glm::dvec3& low, const glm::dvec3& high, const glm::dvec2& at) {
    return at.x >= low.x && at.x <= high.x && at.y >= low.y && at.y <= high.y;
}

}  // namespace

// Triangles by the squares of the plan that they reach.
struct ClosedVolume::Mesh {
    ClosedSurface surface;
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};
    std::int32_t side = 1;  // squares along each axis
    std::vector<std::vector<std::uint32_t>> squares;

    explicit Mesh(ClosedSurface s) : surface(std::move(s)) {
        for (const glm::dvec3& vertex : surface.vertices) {
            low = glm::min(low, vertex);
            high = glm::max(high, vertex);
        }
        constexpr double per_square = 4;
        constexpr double most = 256;
        side = static_cast<std::int32_t>(
            std::clamp(std::sqrt(static_cast<double>(surface.triangles.size()) / per_square), 1.0, most));
        // Fans of long triangles lie in many squares each.
        constexpr std::size_t max_entries = 16;  // for each triangle, of all together
        while (side > 1 && entries() > max_entries * surface.triangles.size())
            side /= 2;
        squares.resize(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
        for (std::uint32_t n = 0; n < surface.triangles.size(); ++n) {
            const auto [first, last] = squares_of(n);
            for (std::int32_t y = first.y; y <= last.y; ++y) {
                for (std::int32_t x = first.x; x <= last.x; ++x)
                    squares[at(x, y)].push_back(n);
            }
        }
    }

    struct Range {
        glm::ivec2 first, last;
    };
    [[nodiscard]] Range squares_of(std::uint32_t n) const {
        const auto [a, b, c] = corners(n);
        return {square_of(glm::min(glm::min(a, b), c)), square_of(glm::max(glm::max(a, b), c))};
    }
    [[nodiscard]] std::size_t entries() const {
        std::size_t count = 0;
        for (std::uint32_t n = 0; n < surface.triangles.size(); ++n) {
            const auto [first, last] = squares_of(n);
            count += static_cast<std::size_t>(last.x - first.x + 1) *
                     static_cast<std::size_t>(last.y - first.y + 1);
        }
        return count;
    }

    struct Corners {
        const glm::dvec3 &a, &b, &c;
    };
    [[nodiscard]] Corners corners(std::uint32_t n) const {
        const glm::uvec3& t = surface.triangles[n];
        return {surface.vertices[t.x], surface.vertices[t.y], surface.vertices[t.z]};
    }
    [[nodiscard]] std::size_t at(std::int32_t x, std::int32_t y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
    }
    [[nodiscard]] glm::ivec2 square_of(const glm::dvec3& p) const {
        const auto along = [&](glm::length_t k) {
            const double share = (p[k] - low[k]) / (high[k] - low[k]);
            return static_cast<std::int32_t>(std::clamp(share * side, 0.0, side - 1.0));
        };
        return {along(0), along(1)};
    }
};

tl::expected<ClosedVolume, std::string> ClosedVolume::make(std::span<const glm::dvec3> positions,
                                                           std::span<const glm::uvec3> triangles) {
    auto surface = closed_surface(positions, triangles);
    if (!surface)
        return tl::unexpected(surface.error());
    ClosedVolume volume;
    volume.mesh_ = std::make_shared<const Mesh>(std::move(*surface));
    return volume;
}

// The signed crossings of the vertical line above the point.
bool ClosedVolume::contains(const glm::dvec3& point) const {
    const Mesh& mesh = *mesh_;
    if (glm::any(glm::lessThan(point, mesh.low)) || glm::any(glm::greaterThan(point, mesh.high)))
        return false;
    const glm::ivec2 square = mesh.square_of(point);
    std::int64_t winding = 0;
    for (const std::uint32_t n : mesh.squares[mesh.at(square.x, square.y)]) {
        const auto [a, b, c] = mesh.corners(n);
        if (!overlaps(glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c), glm::dvec2(point)))
            continue;
        if (is_on({point_of(a), point_of(b), point_of(c)}, point))
            return true;
        const int side = side_of_edge(a, b, point);
        if (side == 0 || side != side_of_edge(b, c, point) || side != side_of_edge(c, a, point))
            continue;
        // Positive where the point lies above the plane of a triangle that is counter-clockwise from above.
        const int above = CGAL::orientation(point_of(a), point_of(b), point_of(c), point_of(point));
        winding += above == -side ? side : 0;
    }
    return winding != 0;
}

const glm::dvec3& ClosedVolume::low() const {
    return mesh_->low;
}

const glm::dvec3& ClosedVolume::high() const {
    return mesh_->high;
}

const std::vector<glm::dvec3>& ClosedVolume::vertices() const {
    return mesh_->surface.vertices;
}

const std::vector<glm::uvec3>& ClosedVolume::triangles() const {
    return mesh_->surface.triangles;
}

}  // namespace drtv::placement
