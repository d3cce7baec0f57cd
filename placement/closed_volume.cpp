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
namespace pmp = CGAL::Polygon_mesh_processing;

}  // namespace

struct ClosedVolume::Mesh {
    explicit Mesh(Surface s) : surface(std::move(s)), side(surface) {}
    Surface surface;
    CGAL::Side_of_triangle_mesh<Surface, Kernel> side;  // refers to `surface`
};

tl::expected<ClosedVolume, std::string> ClosedVolume::make(std::string_view name,
                                                           std::span<const glm::dvec3> positions,
                                                           std::span<const glm::uvec3> triangles) {
    std::map<std::array<double, 3>, std::size_t> index_of;
    std::vector<Kernel::Point_3> points;
    const auto merged = [&](std::uint32_t vertex) {
        const glm::dvec3& p = positions[vertex];
        const auto [entry, added] = index_of.try_emplace({p.x, p.y, p.z}, points.size());
        if (added)
            points.emplace_back(p.x, p.y, p.z);
        return entry->second;
    };
    std::vector<std::array<std::size_t, 3>> faces;
    for (const glm::uvec3& t : triangles) {
        const std::array<std::size_t, 3> face = {merged(t.x), merged(t.y), merged(t.z)};
        if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0])
            faces.push_back(face);
    }
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
    return mesh_->side(Kernel::Point_3(point.x, point.y, point.z)) != CGAL::ON_UNBOUNDED_SIDE;
}

std::vector<glm::dvec3> ClosedVolume::vertices() const {
    std::vector<glm::dvec3> vertices;
    for (const auto vertex : mesh_->surface.vertices()) {
        const Kernel::Point_3& p = mesh_->surface.point(vertex);
        vertices.emplace_back(p.x(), p.y(), p.z());
    }
    return vertices;
}

std::vector<glm::uvec3> ClosedVolume::triangles() const {
    std::vector<glm::uvec3> triangles;
    for (const auto face : mesh_->surface.faces()) {
        glm::uvec3 triangle{};
        glm::length_t corner = 0;
        for (const auto vertex : mesh_->surface.vertices_around_face(mesh_->surface.halfedge(face)))
            triangle[corner++] = static_cast<std::uint32_t>(vertex);
        triangles.push_back(triangle);
    }
    return triangles;
}

}  // namespace drtv::placement
