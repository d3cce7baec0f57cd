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
            const Triangle triangle{corner[0], corner[1] - corner[0], corner[2] - corner[0], worn,
                                    static_cast<std::uint32_t>(n)};
            if (glm::length(glm::cross(triangle.edge1, triangle.edge2)) > 0)
                triangles_.push_back(triangle);
        }
    }
}

namespace {

// Over a surface: far over double's rounding at 100 km, far under anything modelled.
constexpr double step_m = 1e-7;

double luminance(const glm::dvec3& colour) {
    return glm::dot(colour, {0.2126, 0.7152, 0.0722});
}

// IEC 61966-2-1: what an sRGB picture holds for a linear value.
double encoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace

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
    const glm::dvec3 front = front_normal(triangle);
    const bool on_front = glm::dot(front, direction) < 0;
    SurfaceHit hit;
    hit.distance_m = at.distance_m;
    hit.normal = on_front ? front : -front;
    if (!on_front && !material.double_sided && !worn.vegetation && !(material.diffuse_transmission > 0) &&
        !(material.transmission > 0)) {
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
    hit.clear = clear_share(triangle, at);
    const double scattering = 1 - transmission(triangle, at);
    hit.reflected *= scattering;
    hit.transmitted *= scattering;
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

glm::dvec3 Scene::front_normal(const Triangle& triangle) const {
    return glm::normalize(glm::cross(triangle.edge1, triangle.edge2)) *
           (worn_[triangle.worn].mirrored ? -1.0 : 1.0);
}

double Scene::transmission(const Triangle& triangle, const Crossing& at) const {
    const Worn& worn = worn_[triangle.worn];
    double share = static_cast<double>(worn.material->transmission);
    // The picture's numbers are no colours: its red as the file has it.
    if (share > 0 && worn.material->transmission_texture.present())
        share *= encoded(
            picture(worn.material->transmission_texture, worn.primitive->transmission_uvs, triangle, at).x);
    return share;
}

glm::dvec3 Scene::clear_share(const Triangle& triangle, const Crossing& at) const {
    return glm::clamp(glm::dvec3(colour(triangle, at)), 0.0, 1.0) * transmission(triangle, at);
}

Scene::Met Scene::nearest(const glm::dvec3& origin, const glm::dvec3& direction, double far_m,
                          Random& random) const {
    Met met;
    double far = far_m;
    bvh_->walk(origin, direction, far, [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t n = first; n < first + count; ++n) {
            const auto crossing = cross(triangles_[n], origin, direction, far);
            if (!crossing || !is_there(triangles_[n], *crossing, random))
                continue;
            met = {&triangles_[n], *crossing};
            far = crossing->distance_m;
        }
        return true;
    });
    return met;
}

Scene::Met Scene::front_of(const Met& met, const glm::dvec3& origin, const glm::dvec3& direction,
                           Random& random) const {
    const glm::dvec3 normal = front_normal(*met.triangle);
    const double cosine = glm::dot(normal, direction);
    if (!(cosine > 0))
        return met;  // is one
    // What float matrices make of two walls in one plane.
    const glm::dvec3 point = glm::abs(origin + direction * met.at.distance_m);
    const double plane_m = 1e-6 * (1 + std::max({point.x, point.y, point.z}));
    Met found = met;
    double far = met.at.distance_m + plane_m / cosine;
    bvh_->walk(origin, direction, far, [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t n = first; n < first + count; ++n) {
            const glm::dvec3 other = front_normal(triangles_[n]);
            const auto crossing = cross(triangles_[n], origin, direction, far);
            if (glm::dot(other, normal) < -0.9999 && crossing && is_there(triangles_[n], *crossing, random))
                found = {&triangles_[n], *crossing};
        }
        return true;
    });
    return found;
}

std::optional<SurfaceHit> Scene::closest(const glm::dvec3& origin, const glm::dvec3& direction,
                                         Random& random, glm::dvec3& tint) const {
    double gone_m = 0;
    for (;;) {
        const glm::dvec3 start = origin + direction * gone_m;
        Met met = nearest(start, direction, std::numeric_limits<double>::infinity(), random);
        if (met.triangle == nullptr)
            return std::nullopt;
        met = front_of(met, start, direction, random);
        SurfaceHit hit = surface(*met.triangle, met.at, direction);
        hit.distance_m += gone_m;
        const double passes = luminance(hit.clear);
        if (!(passes > 0 && random.next() < passes)) {
            hit.reflected /= 1 - passes;
            hit.transmitted /= 1 - passes;
            // A pane glows as far as it is not clear in its brightest channel, as a blended one by its alpha.
            const double most = std::max({hit.clear.x, hit.clear.y, hit.clear.z});
            hit.emitted *= (1 - most) / (1 - passes);
            return hit;
        }
        tint *= hit.clear / passes;
        gone_m = hit.distance_m + step_m;
    }
}

glm::dvec3 Scene::arriving(const glm::dvec3& origin, const glm::dvec3& direction, double far_m,
                           Random& random) const {
    const glm::dvec3 end = origin + direction * far_m;
    const double plane_m = 1e-6 * (1 + std::max({std::abs(end.x), std::abs(end.y), std::abs(end.z)}));
    glm::dvec3 share(1);
    for (double gone_m = 0;;) {
        const Met met = nearest(origin + direction * gone_m, direction, far_m - gone_m, random);
        if (met.triangle == nullptr)
            return share;
        const bool at_end =
            std::abs(glm::dot(front_normal(*met.triangle), end - met.triangle->corner)) < plane_m;
        if (!at_end)
            share *= clear_share(*met.triangle, met.at);
        if (share == glm::dvec3(0))
            return share;
        gone_m += met.at.distance_m + step_m;
    }
}

}  // namespace drtv::reference
