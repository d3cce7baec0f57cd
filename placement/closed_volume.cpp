#include "placement/closed_volume.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>

#include <array>
#include <map>
#include <vector>

namespace drtv::placement {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Face = std::array<std::size_t, 3>;
namespace pmp = CGAL::Polygon_mesh_processing;

// Triangles that need not hang together, each vertex named by all faces at its position.
struct Soup {
    std::vector<Kernel::Point_3> points;
    std::vector<Face> faces;
};

bool is_degenerate(const Face& face) {
    return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
}

Soup merged(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles) {
    Soup soup;
    std::map<std::array<double, 3>, std::size_t> index_of;
    const auto point_at = [&](std::uint32_t vertex) {
        const glm::dvec3& p = positions[vertex];
        const auto [entry, added] = index_of.try_emplace({p.x, p.y, p.z}, soup.points.size());
        if (added)
            soup.points.emplace_back(p.x, p.y, p.z);
        return entry->second;
    };
    for (const glm::uvec3& t : triangles) {
        const Face face = {point_at(t.x), point_at(t.y), point_at(t.z)};
        if (!is_degenerate(face))
            soup.faces.push_back(face);
    }
    return soup;
}

}  // namespace

struct ClosedVolume::Mesh {
    explicit Mesh(Surface s) : surface(std::move(s)), side(surface) {}
    Surface surface;
    CGAL::Side_of_triangle_mesh<Surface, Kernel> side;  // refers to `surface`
};

tl::expected<ClosedVolume, std::string> ClosedVolume::make(std::string_view name,
                                                           std::span<const glm::dvec3> positions,
                                                           std::span<const glm::uvec3> triangles) {
    auto [points, faces] = merged(positions, triangles);
    const auto fail = [&](std::string_view reason) {
        return tl::unexpected(fmt::format("the volume '{}' {}", name, reason));
    };
    if (faces.empty())
        return fail("has no triangles");
    if (!pmp::orient_polygon_soup(points, faces) || !pmp::is_polygon_soup_a_polygon_mesh(faces))
        return fail("is not a surface: some edge belongs to three triangles or more");
    Surface surface;
    pmp::polygon_soup_to_polygon_mesh(points, faces, surface);
    if (!CGAL::is_closed(surface))
        return fail("is open: a closed mesh is needed to tell inside from outside");
    pmp::orient(surface);
    ClosedVolume volume;
    volume.mesh_ = std::make_shared<const Mesh>(std::move(surface));
    // The first question builds the search tree; after it, asking only reads.
    static_cast<void>(volume.contains(positions[0]));
    return volume;
}

bool ClosedVolume::contains(const glm::dvec3& point) const {
    const CGAL::Bounded_side side = mesh_->side(Kernel::Point_3(point.x, point.y, point.z));
    return side != CGAL::ON_UNBOUNDED_SIDE;
}

std::vector<glm::dvec3> ClosedVolume::vertices() const {
    const Surface& surface = mesh_->surface;
    std::vector<glm::dvec3> vertices;
    for (const auto vertex : surface.vertices()) {
        const Kernel::Point_3& p = surface.point(vertex);
        vertices.emplace_back(p.x(), p.y(), p.z());
    }
    return vertices;
}

std::vector<glm::uvec3> ClosedVolume::triangles() const {
    const Surface& surface = mesh_->surface;
    std::vector<glm::uvec3> triangles;
    for (const auto face : surface.faces()) {
        glm::uvec3 triangle{};
        glm::length_t corner = 0;
        for (const auto vertex : surface.vertices_around_face(surface.halfedge(face)))
            triangle[corner++] = static_cast<std::uint32_t>(vertex);
        triangles.push_back(triangle);
    }
    return triangles;
}

}  // namespace drtv::placement
