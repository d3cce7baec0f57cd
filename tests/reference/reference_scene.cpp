#include "tests/reference/reference_scene.h"

#include "bakerd/map/texture.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace drtv::reference {
namespace {

constexpr std::uint32_t leaf_size = 3;
constexpr double albedo_limit = 0.95;  // the product's promise, stated again on purpose

}  // namespace

Scene::Scene(const map::Map& map) : map_(map) {
    for (const map::Object& object : map.objects) {
        const glm::dmat4x3 world_from_object(object.world_from_object);
        // A mirroring turns the winding over; the object space tells the front all the same.
        const double handedness = glm::determinant(glm::dmat3(world_from_object)) < 0 ? -1.0 : 1.0;
        for (const map::Primitive& primitive : map.meshes[object.mesh].primitives) {
            for (const glm::uvec3& t : primitive.triangles) {
                std::array<glm::dvec3, 3> corners;
                for (glm::length_t k = 0; k < 3; ++k) corners[static_cast<std::size_t>(k)] = world_from_object * glm::dvec4(glm::dvec3(primitive.positions[t[k]]), 1.0);
                Triangle triangle;
                triangle.corner = corners[0];
                triangle.edge1 = corners[1] - corners[0];
                triangle.edge2 = corners[2] - corners[0];
                const glm::dvec3 across = glm::cross(triangle.edge1, triangle.edge2);
                if (!(glm::length(across) > 0)) continue;
                triangle.front = glm::normalize(across) * handedness;
                triangle.primitive = &primitive;
                triangle.vertices = t;
                triangle.two_sided = map.materials[primitive.material].double_sided || object.role == map::Role::vegetation;
                triangles_.push_back(triangle);
            }
        }
    }
    nodes_.push_back({{}, {}, 0, static_cast<std::uint32_t>(triangles_.size())});
    if (!triangles_.empty()) split(0);
}

// Halves the triangles at the median centroid along the node's longest side.
void Scene::split(std::size_t node) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    const std::uint32_t first = nodes_[node].first, count = nodes_[node].count;
    for (std::uint32_t n = first; n < first + count; ++n) {
        const Triangle& t = triangles_[n];
        for (const glm::dvec3& p : {t.corner, t.corner + t.edge1, t.corner + t.edge2}) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
    nodes_[node].low = low - 1e-6;
    nodes_[node].high = high + 1e-6;
    if (count <= leaf_size) return;
    const glm::dvec3 size = high - low;
    const glm::length_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t half = count / 2;
    const auto begin = triangles_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [&](const Triangle& a, const Triangle& b) {
        return 3 * a.corner[axis] + a.edge1[axis] + a.edge2[axis] < 3 * b.corner[axis] + b.edge1[axis] + b.edge2[axis];
    });
    const std::size_t child = nodes_.size();
    nodes_[node].first = static_cast<std::uint32_t>(child);
    nodes_[node].count = 0;
    nodes_.push_back({{}, {}, first, half});
    nodes_.push_back({{}, {}, first + half, count - half});
    split(child);
    split(child + 1);
}

bool Scene::meets(const Node& node, const glm::dvec3& origin, const glm::dvec3& inverse, double far) const {
    double enter = 0, leave = far;
    for (glm::length_t k = 0; k < 3; ++k) {
        const double a = (node.low[k] - origin[k]) * inverse[k], b = (node.high[k] - origin[k]) * inverse[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
}

glm::dvec4 Scene::colour(const Triangle& triangle, double u, double v) const {
    const map::Primitive& primitive = *triangle.primitive;
    const map::Material& material = map_.materials[primitive.material];
    const glm::uvec3& at = triangle.vertices;
    glm::dvec4 result(material.base_colour);
    if (!primitive.colours.empty()) {
        result *= (1 - u - v) * glm::dvec4(primitive.colours[at.x]) + u * glm::dvec4(primitive.colours[at.y]) + v * glm::dvec4(primitive.colours[at.z]);
    }
    if (material.texture != map::no_texture) {
        const glm::dvec2 uv = (1 - u - v) * glm::dvec2(primitive.uvs[at.x]) + u * glm::dvec2(primitive.uvs[at.y]) + v * glm::dvec2(primitive.uvs[at.z]);
        const glm::dvec3 row(uv, 1.0);
        const glm::vec2 transformed(glm::dot(glm::dvec3(material.texture_u_from_uv), row), glm::dot(glm::dvec3(material.texture_v_from_uv), row));
        result *= glm::dvec4(map::sample(map_.textures[material.texture], transformed));
    }
    return result;
}

std::optional<SurfaceHit> Scene::closest(const glm::dvec3& origin, const glm::dvec3& direction) const {
    double best = std::numeric_limits<double>::infinity(), best_u = 0, best_v = 0;
    const Triangle* found = nullptr;
    const glm::dvec3 inverse(1 / direction.x, 1 / direction.y, 1 / direction.z);
    std::array<std::uint32_t, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        if (!meets(node, origin, inverse, best)) continue;
        if (node.count == 0) {
            const Node &a = nodes_[node.first], &b = nodes_[node.first + 1];
            const bool a_nearer = glm::dot(a.low + a.high - b.low - b.high, direction) < 0;
            stack[depth++] = a_nearer ? node.first + 1 : node.first;
            stack[depth++] = a_nearer ? node.first : node.first + 1;
            continue;
        }
        for (std::uint32_t n = node.first; n < node.first + node.count; ++n) {
            // Moller and Trumbore, "Fast, Minimum Storage Ray-Triangle Intersection", 1997.
            const Triangle& t = triangles_[n];
            const glm::dvec3 p = glm::cross(direction, t.edge2);
            const double determinant = glm::dot(t.edge1, p);
            if (determinant == 0) continue;
            const glm::dvec3 s = origin - t.corner;
            const double u = glm::dot(s, p) / determinant;
            if (u < 0 || u > 1) continue;
            const glm::dvec3 q = glm::cross(s, t.edge1);
            const double v = glm::dot(direction, q) / determinant;
            if (v < 0 || u + v > 1) continue;
            const double distance = glm::dot(t.edge2, q) / determinant;
            if (!(distance > 0) || distance >= best) continue;
            const map::Material& material = map_.materials[t.primitive->material];
            if (material.masked && colour(t, u, v).w < static_cast<double>(material.alpha_cutoff)) continue;
            best = distance;
            best_u = u;
            best_v = v;
            found = &t;
        }
    }
    if (found == nullptr) return std::nullopt;
    const bool front = glm::dot(found->front, direction) < 0;
    SurfaceHit hit;
    hit.distance_m = best;
    hit.normal = front ? found->front : -found->front;
    hit.albedo = glm::clamp(glm::dvec3(colour(*found, best_u, best_v)), 0.0, albedo_limit);
    hit.absorbs = !front && !found->two_sided;
    return hit;
}

}  // namespace drtv::reference
