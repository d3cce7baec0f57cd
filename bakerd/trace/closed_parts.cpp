#include "bakerd/trace/closed_parts.h"

#include "bakerd/trace/surface.h"
#include "placement/mesh_parts.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace drtv::trace {
namespace {

// All primitives of a mesh together, with one vertex for each position.
struct WholeMesh {
    std::vector<glm::dvec3> positions;
    std::vector<glm::uvec3> triangles;
};

WholeMesh whole(const map::Mesh& mesh) {
    std::vector<glm::dvec3> vertices;
    for (const map::Primitive& primitive : mesh.primitives) {
        for (const glm::vec3& position : primitive.positions)
            vertices.emplace_back(position);
    }
    placement::MergedVertices merged = placement::merge_vertices(vertices);
    WholeMesh result{std::move(merged.positions), {}};
    std::size_t first = 0;
    for (const map::Primitive& primitive : mesh.primitives) {
        for (const glm::uvec3& t : primitive.triangles)
            result.triangles.emplace_back(
                merged.number[first + t.x], merged.number[first + t.y], merged.number[first + t.z]);
        first += primitive.positions.size();
    }
    return result;
}

// A part while its triangles are added up.
struct Sum {
    double six_volumes = 0;
    glm::dvec3 from{};  // the volumes' common corner, one of the part's
    map::Bounds bounds;
    bool is_there = true;  // everywhere
};

bool bounds_volume(const Sum& sum) {
    // Of its cube: two sheets back to back bound less.
    constexpr double min_share = 1e-7;
    const glm::dvec3 size(sum.bounds.high - sum.bounds.low);
    const double side = std::max({size.x, size.y, size.z});
    return sum.is_there && std::abs(sum.six_volumes) > 6 * min_share * side * side * side;
}

}  // namespace

ClosedParts::ClosedParts(const map::Map& map, const map::Mesh& mesh) {
    const auto [positions, triangles] = whole(mesh);
    const placement::MeshParts all = placement::parts_by_edges(triangles, placement::half_edges(triangles));
    std::vector<Sum> sums(all.closed.size());
    std::uint32_t n = 0;
    for (const map::Primitive& primitive : mesh.primitives) {
        first_.push_back(n);
        const bool may_be_away = has_holes(map.materials[primitive.material]);
        for (std::uint32_t t = 0; t < primitive.triangles.size(); ++t, ++n) {
            const std::uint32_t part = all.part_of[n];
            if (part == placement::no_part || !all.closed[part])
                continue;
            Sum& sum = sums[part];
            if (may_be_away && sum.is_there)
                sum.is_there = presence_of(map, primitive, t) == Presence::whole;
            const glm::dvec3& a = positions[triangles[n].x];
            const glm::dvec3& b = positions[triangles[n].y];
            const glm::dvec3& c = positions[triangles[n].z];
            if (sum.bounds.empty())
                sum.from = a;
            for (const glm::dvec3* corner : {&a, &b, &c})
                sum.bounds.extend(glm::vec3(*corner));
            sum.six_volumes += glm::dot(a - sum.from, glm::cross(b - sum.from, c - sum.from));
        }
    }
    std::vector<std::uint32_t> number(sums.size(), none);
    for (std::size_t part = 0; part < sums.size(); ++part) {
        if (!all.closed[part] || !bounds_volume(sums[part]))
            continue;
        number[part] = static_cast<std::uint32_t>(parts_.size());
        parts_.push_back({sums[part].six_volumes > 0, sums[part].bounds});
    }
    if (empty())
        return;
    for (const std::uint32_t part : all.part_of)
        part_of_.push_back(part == placement::no_part ? none : number[part]);
}

}  // namespace drtv::trace
