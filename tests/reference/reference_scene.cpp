#include "tests/reference/reference_scene.h"

#include "bakerd/map/texture.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace drtv::reference {
namespace {

constexpr double albedo_limit = 0.95;      // the product's promise, stated again on purpose
constexpr double leaf_transmission = 0.5;  // of the base colour, where a plant's material says nothing
constexpr float infinity = std::numeric_limits<float>::infinity();

Box box_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    Box box;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<glm::length_t>(k);
        box.low[k] = std::nextafter(static_cast<float>(std::min({a[axis], b[axis], c[axis]})), -infinity);
        box.high[k] = std::nextafter(static_cast<float>(std::max({a[axis], b[axis], c[axis]})), infinity);
    }
    return box;
}

bool apart(const glm::dvec3& low, const glm::dvec3& high, const Region& region) {
    return glm::any(glm::lessThan(high, region.low)) || glm::any(glm::greaterThan(low, region.high));
}

}  // namespace

Scene::Scene(const map::Map& map, const Region& region) : map_(map) {
    for (const map::Object& object : map.objects) {
        if (!apart(glm::dvec3(object.bounds.low) - 0.01, glm::dvec3(object.bounds.high) + 0.01, region))
            add_object(object, region);
    }
    std::vector<Box> boxes;
    boxes.reserve(triangles_.size());
    for (const Triangle& t : triangles_)
        boxes.push_back(box_of(t.corner, t.corner + t.edge1, t.corner + t.edge2));
    std::vector<std::uint32_t> order;
    bvh_.emplace(boxes, order);
    std::vector<Triangle> sorted;
    sorted.reserve(order.size());
    for (const std::uint32_t n : order)
        sorted.push_back(triangles_[n]);
    triangles_ = std::move(sorted);
}

void Scene::add_object(const map::Object& object, const Region& region) {
    const std::size_t first = triangles_.size();
    const glm::dmat4x3 world_from_object(object.world_from_object);
    // A mirroring turns the winding over; the object space tells the front all the same.
    const bool mirrored = glm::determinant(glm::dmat3(world_from_object)) < 0;
    for (const map::Primitive& primitive : map_.meshes[object.mesh].primitives) {
        const map::Material& material = map_.materials[primitive.material];
        const auto worn = static_cast<std::uint32_t>(worn_.size());
        worn_.push_back({&primitive, &material, object.role == map::Role::vegetation, mirrored,
                         material.alpha_mode == map::AlphaMode::opaque});
        for (std::size_t n = 0; n < primitive.triangles.size(); ++n) {
            std::array<glm::dvec3, 3> corner;
            for (std::size_t k = 0; k < 3; ++k) {
                corner[k] =
                    world_from_object *
                    glm::dvec4(
                        glm::dvec3(
                            primitive.positions[primitive.triangles[n][static_cast<glm::length_t>(k)]]),
                        1.0);
            }
            if (apart(glm::min(corner[0], glm::min(corner[1], corner[2])),
                      glm::max(corner[0], glm::max(corner[1], corner[2])), region))
                continue;
            const Triangle triangle{corner[0], corner[1] - corner[0],         corner[2] - corner[0],
                                    worn,      static_cast<std::uint32_t>(n), false};
            if (glm::length(glm::cross(triangle.edge1, triangle.edge2)) > 0)
                triangles_.push_back(triangle);
        }
    }
    mark_twins(first);
}

// Among the triangles from `first` on.
void Scene::mark_twins(std::size_t first) {
    using Corner = std::array<double, 3>;
    std::map<std::array<Corner, 3>, std::vector<std::size_t>> by_corners;
    for (std::size_t n = first; n < triangles_.size(); ++n) {
        const Triangle& t = triangles_[n];
        std::array<Corner, 3> corners;
        std::size_t k = 0;
        for (const glm::dvec3& edge : {glm::dvec3(0), t.edge1, t.edge2}) {
            // Rounded, because corner + edge is.
            const glm::dvec3 corner = glm::round((t.corner + edge) * 1e6);
            corners[k++] = {corner.x, corner.y, corner.z};
        }
        std::sort(corners.begin(), corners.end());
        by_corners[corners].push_back(n);
    }
    for (const auto& [corners, numbers] : by_corners) {
        for (const std::size_t a : numbers) {
            for (const std::size_t b : numbers) {
                const auto front = [&](std::size_t n) {
                    return glm::cross(triangles_[n].edge1, triangles_[n].edge2);
                };
                if (glm::dot(front(a), front(b)) < 0)
                    triangles_[a].twin = true;
            }
        }
    }
}

// Moller and Trumbore, "Fast, Minimum Storage Ray-Triangle Intersection", 1997.
std::optional<Scene::Crossing> Scene::cross(const Triangle& t, const glm::dvec3& origin,
                                            const glm::dvec3& direction, double far_m) {
    const glm::dvec3 p = glm::cross(direction, t.edge2);
    const double determinant = glm::dot(t.edge1, p);
    if (determinant == 0)
        return std::nullopt;
    const double inverse = 1 / determinant;
    const glm::dvec3 s = origin - t.corner;
    const double u = glm::dot(s, p) * inverse;
    if (!(u >= 0 && u <= 1))
        return std::nullopt;
    const glm::dvec3 q = glm::cross(s, t.edge1);
    const double v = glm::dot(direction, q) * inverse;
    if (!(v >= 0 && u + v <= 1))
        return std::nullopt;
    const double distance = glm::dot(t.edge2, q) * inverse;
    if (!(distance > 0 && distance < far_m))
        return std::nullopt;
    return Crossing{distance, u, v};
}

glm::dvec4 Scene::picture(const map::TextureView& view, const std::vector<glm::vec2>& uvs,
                          const Triangle& triangle, const Crossing& at) const {
    const glm::uvec3& t = worn_[triangle.worn].primitive->triangles[triangle.number];
    const glm::dvec3 uv1(
        (1 - at.u - at.v) * glm::dvec2(uvs[t.x]) + at.u * glm::dvec2(uvs[t.y]) + at.v * glm::dvec2(uvs[t.z]),
        1.0);
    const glm::vec2 uv(glm::dot(glm::dvec3(view.u_from_uv), uv1), glm::dot(glm::dvec3(view.v_from_uv), uv1));
    return glm::dvec4(map::sample(map_.textures[view.texture], uv));
}

glm::dvec4 Scene::colour(const Triangle& triangle, const Crossing& at) const {
    const Worn& worn = worn_[triangle.worn];
    const auto& colours = worn.primitive->colours;
    glm::dvec4 result(worn.material->base_colour);
    if (!colours.empty()) {
        const glm::uvec3& t = worn.primitive->triangles[triangle.number];
        result *= (1 - at.u - at.v) * glm::dvec4(colours[t.x]) + at.u * glm::dvec4(colours[t.y]) +
                  at.v * glm::dvec4(colours[t.z]);
    }
    if (worn.material->base_texture.present())
        result *= picture(worn.material->base_texture, worn.primitive->uvs, triangle, at);
    return result;
}

bool Scene::is_there(const Triangle& triangle, const Crossing& at, Random& random) const {
    const Worn& worn = worn_[triangle.worn];
    if (worn.always_there)
        return true;
    const double alpha = colour(triangle, at).w;
    if (worn.material->alpha_mode == map::AlphaMode::mask)
        return alpha >= static_cast<double>(worn.material->alpha_cutoff);
    return random.next() < alpha;
}

SurfaceHit Scene::surface(const Triangle& triangle, const Crossing& at, const glm::dvec3& direction) const {
    const Worn& worn = worn_[triangle.worn];
    const map::Material& material = *worn.material;
    const glm::dvec3 front =
        glm::normalize(glm::cross(triangle.edge1, triangle.edge2)) * (worn.mirrored ? -1.0 : 1.0);
    const bool on_front = glm::dot(front, direction) < 0;
    SurfaceHit hit;
    hit.distance_m = at.distance_m;
    hit.normal = on_front ? front : -front;
    if (!on_front && !triangle.twin && !material.double_sided && !worn.vegetation &&
        !(material.diffuse_transmission > 0)) {
        hit.absorbs = true;
        return hit;
    }
    const glm::dvec3 base = glm::clamp(glm::dvec3(colour(triangle, at)), 0.0, albedo_limit);
    hit.reflected = base;
    if (material.diffuse_transmission > 0) {
        hit.reflected = base * (1 - static_cast<double>(material.diffuse_transmission));
        hit.transmitted = glm::dvec3(material.diffuse_transmission_colour) *
                          static_cast<double>(material.diffuse_transmission);
    } else if (worn.vegetation && (material.double_sided || material.alpha_mode != map::AlphaMode::opaque)) {
        hit.transmitted = base * leaf_transmission;
    }
    const glm::dvec3 excess = glm::max(glm::dvec3(1), (hit.reflected + hit.transmitted) / albedo_limit);
    hit.reflected /= excess;
    hit.transmitted /= excess;
    if ((on_front || material.double_sided) && material.emission != glm::vec3(0)) {
        hit.emitted = glm::dvec3(material.emission) / lumens_per_watt;
        if (material.emission_texture.present())
            hit.emitted *=
                glm::dvec3(picture(material.emission_texture, worn.primitive->emission_uvs, triangle, at));
    }
    return hit;
}

std::optional<SurfaceHit> Scene::closest(const glm::dvec3& origin, const glm::dvec3& direction,
                                         Random& random) const {
    double far = std::numeric_limits<double>::infinity();
    Crossing best{};
    const Triangle* found = nullptr;
    bvh_->walk(origin, direction, far, [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t n = first; n < first + count; ++n) {
            const auto crossing = cross(triangles_[n], origin, direction, far);
            if (!crossing || !is_there(triangles_[n], *crossing, random))
                continue;
            best = *crossing;
            far = best.distance_m;
            found = &triangles_[n];
        }
        return true;
    });
    if (found == nullptr)
        return std::nullopt;
    return surface(*found, best, direction);
}

bool Scene::blocked(const glm::dvec3& origin, const glm::dvec3& direction, double far_m,
                    Random& random) const {
    bool found = false;
    bvh_->walk(origin, direction, far_m, [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t n = first; n < first + count && !found; ++n) {
            const auto crossing = cross(triangles_[n], origin, direction, far_m);
            found = crossing && is_there(triangles_[n], *crossing, random);
        }
        return !found;
    });
    return found;
}

}  // namespace drtv::reference
