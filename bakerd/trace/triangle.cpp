#include "bakerd/trace/triangle.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace drtv::trace {
namespace {

// x, y, z and 0, on which the compiler computes at once. A sum of three takes them in the order (x + y) + z.
using Double4 = double __attribute__((vector_size(32)));

Double4 four(const glm::vec3& v) {
    return Double4{double{v.x}, double{v.y}, double{v.z}, 0};
}

struct WorldCorners {
    Double4 a;
    Double4 b;
    Double4 c;
};

WorldCorners in_world(const glm::mat4x3& world_from_object, const ObjectTriangle& triangle) {
    const Double4 x = four(world_from_object[0]);
    const Double4 y = four(world_from_object[1]);
    const Double4 z = four(world_from_object[2]);
    const Double4 origin = four(world_from_object[3]);
    const auto corner = [&](const glm::vec3& p) {
        return (x * double{p.x} + y * double{p.y}) + (z * double{p.z} + origin);
    };
    return {corner(triangle.a), corner(triangle.b), corner(triangle.c)};
}

Double4 cross(const Double4& a, const Double4& b) {
    const auto turned = [](const Double4& v) { return __builtin_shufflevector(v, v, 1, 2, 0, 3); };
    return turned(a * turned(b) - turned(a) * b);
}

// The sums of the components of each.
Double4 sums(const Double4& p, const Double4& q, const Double4& r, const Double4& s) {
    const Double4 of_p_and_q =
        __builtin_shufflevector(p, q, 0, 4, 2, 6) + __builtin_shufflevector(p, q, 1, 5, 3, 7);
    const Double4 of_r_and_s =
        __builtin_shufflevector(r, s, 0, 4, 2, 6) + __builtin_shufflevector(r, s, 1, 5, 3, 7);
    return __builtin_shufflevector(of_p_and_q, of_r_and_s, 0, 1, 4, 5) +
           __builtin_shufflevector(of_p_and_q, of_r_and_s, 2, 3, 6, 7);
}

// The square of a cosine to the normal.
constexpr double flat_grazing = 0x1p-20;

double square(double x) {
    return x * x;
}

// Whether the start lies beyond the plane by more than it can be off: half of what path ends are kept away.
// Of a ray along an axis Embree is asked beside the line (Sides), where this may look otherwise.
bool starts_beyond(const Ray& ray, double distance_m, double facing, const glm::dvec3& normal) {
    const double across = -distance_m * std::abs(facing);
    const double off = static_cast<double>(rounding_m(ray, 0)) * 0.5;
    return across > 0 && square(across) > square(off) * glm::dot(normal, normal);
}

}  // namespace

Triangle transformed(const glm::mat4x3& world_from_object, const ObjectTriangle& triangle) {
    const WorldCorners corners = in_world(world_from_object, triangle);
    const auto three = [](const Double4& v) { return glm::dvec3(v[0], v[1], v[2]); };
    return {three(corners.a), three(corners.b), three(corners.c)};
}

std::optional<Intersection> intersect(const Ray& ray,
                                      const glm::mat4x3& world_from_object,
                                      const ObjectTriangle& triangle) {
    const WorldCorners corners = in_world(world_from_object, triangle);
    const Double4 direction = four(ray.direction);
    const Double4 a = corners.a - four(ray.origin);
    const Double4 ab = corners.b - corners.a;
    const Double4 ac = corners.c - corners.a;
    const Double4 normal = cross(ab, ac);
    const Double4 moment = cross(a, direction);
    const Double4 products = sums(normal * direction, normal * a, ac * moment, ab * moment);
    const double facing = products[0];
    if (facing == 0)
        return std::nullopt;
    const Double4 quotients = products / facing;
    const double u = std::clamp(quotients[2], 0.0, 1.0);
    const double v = std::clamp(-quotients[3], 0.0, 1.0 - u);

    Intersection found;
    found.distance_m = std::max(quotients[1], 0.0);
    found.u = static_cast<float>(u);
    found.v = static_cast<float>(v);
    found.normal = {normal[0], normal[1], normal[2]};
    if (starts_beyond(ray, quotients[1], facing, found.normal))
        return std::nullopt;
    if (square(facing) < flat_grazing * glm::dot(found.normal, found.normal)) {
        // Beside the triangle its plane may be anywhere: not beyond what the corners span.
        const Double4 along = sums(a * direction, ab * direction, ac * direction, a);
        const double of_a_m = along[0];
        const double of_b_m = of_a_m + along[1];
        const double of_c_m = of_a_m + along[2];
        found.distance_m = std::max(
            std::clamp(quotients[1], std::min({of_a_m, of_b_m, of_c_m}), std::max({of_a_m, of_b_m, of_c_m})),
            0.0);
    }
    return found;
}

float order_of(const Intersection& at,
               const Ray& ray,
               const glm::mat4x3& world_from_space,
               const ObjectTriangle& triangle) {
    const double slack_m = static_cast<double>(query_slack(ray, static_cast<float>(at.distance_m)));
    const glm::dmat3 space_from_world = glm::inverse(glm::dmat3(glm::mat3(world_from_space)));
    const glm::dvec3 a(triangle.a);
    const glm::dvec3 b(triangle.b);
    const glm::dvec3 c(triangle.c);
    const glm::dvec3 normal = glm::abs(glm::cross(b - a, c - a));
    const double facing =
        std::abs(glm::dot(glm::cross(b - a, c - a), space_from_world * glm::dvec3(ray.direction)));
    // Along each axis of the space the transform rounds coordinates of the world, and the test those of the
    // corners.
    const glm::dvec3 translation = glm::abs(glm::dvec3(world_from_space[3]));
    const glm::dvec3 corners = glm::max(glm::max(glm::abs(a), glm::abs(b)), glm::abs(c));
    const double world_m = static_cast<double>(coordinate_m(ray)) + at.distance_m +
                           std::max({translation.x, translation.y, translation.z});
    double error = 0;
    for (glm::length_t k = 0; k < 3; ++k) {
        const double row = std::abs(space_from_world[0][k]) + std::abs(space_from_world[1][k]) +
                           std::abs(space_from_world[2][k]);
        error += normal[k] * (world_m * row + corners[k] + glm::distance(a, b) + glm::distance(b, c));
    }
    const double error_m = error * static_cast<double>(embree_rounding) / facing;
    return static_cast<float>(at.distance_m + std::max(error_m - slack_m, 0.0));
}

bool in_one_plane(const Ray& ray, const Intersection& a, const Intersection& b) {
    constexpr double even = 0.9999;  // the cosine between their normals
    const double cosine = glm::dot(a.normal, b.normal);
    const double squares = glm::dot(a.normal, a.normal) * glm::dot(b.normal, b.normal);
    if (square(cosine) < square(even) * squares)
        return false;
    const auto distance_m = static_cast<float>(a.distance_m);
    const double across_m = std::abs(a.distance_m - b.distance_m) *
                            std::abs(glm::dot(a.normal, glm::dvec3(ray.direction))) / glm::length(a.normal);
    return across_m <= static_cast<double>(rounding_m(ray, distance_m));
}

std::optional<double> height_at(const Triangle& triangle, glm::vec2 at) {
    const auto& [a, b, c] = triangle;
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    if (std::abs(normal.z) <= 1e-6 * glm::length(normal))
        return std::nullopt;
    const double z_m = a.z - (normal.x * (double{at.x} - a.x) + normal.y * (double{at.y} - a.y)) / normal.z;
    return std::clamp(z_m, std::min({a.z, b.z, c.z}), std::max({a.z, b.z, c.z}));
}

// Ericson, Real-Time Collision Detection, 5.1.5: by the regions of the corners, edges and face.
double distance_to(const Triangle& triangle, const glm::dvec3& point) {
    const auto& [a, b, c] = triangle;
    const glm::dvec3 ab = b - a;
    const glm::dvec3 ac = c - a;
    const glm::dvec3 ap = point - a;
    const glm::dvec3 bp = point - b;
    const glm::dvec3 cp = point - c;
    const double d1 = glm::dot(ab, ap);
    const double d2 = glm::dot(ac, ap);
    const double d3 = glm::dot(ab, bp);
    const double d4 = glm::dot(ac, bp);
    const double d5 = glm::dot(ab, cp);
    const double d6 = glm::dot(ac, cp);
    if (d1 <= 0 && d2 <= 0)
        return glm::length(ap);
    if (d3 >= 0 && d4 <= d3)
        return glm::length(bp);
    if (d6 >= 0 && d5 <= d6)
        return glm::length(cp);
    const double of_a = d3 * d6 - d5 * d4;
    const double of_b = d5 * d2 - d1 * d6;
    const double of_c = d1 * d4 - d3 * d2;
    if (of_c <= 0 && d1 >= 0 && d3 <= 0)
        return glm::length(ap - ab * (d1 / (d1 - d3)));
    if (of_b <= 0 && d2 >= 0 && d6 <= 0)
        return glm::length(ap - ac * (d2 / (d2 - d6)));
    if (of_a <= 0 && d4 >= d3 && d5 >= d6)
        return glm::length(bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
    return glm::length(ap - (ab * of_b + ac * of_c) / (of_a + of_b + of_c));
}

}  // namespace drtv::trace
