// A triangle in the world, and what is asked of it. Embree answers in single precision and by way of the
// reciprocals that each CPU vendor approximates differently (`rcpps`), so it is only asked which triangles a
// ray meets. Where it meets them is worked out here from the corners, in double precision, with IEEE
// operations alone: the same bits on every CPU.
#pragma once

#include "bakerd/trace/ray.h"

#include <glm/mat4x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace drtv::trace {

// World, metres; counter-clockwise seen from the front unless the transform mirrored.
struct Triangle {
    glm::dvec3 a;
    glm::dvec3 b;
    glm::dvec3 c;
};

// Corners in object space, as the map has them.
struct ObjectTriangle {
    const glm::vec3 &a, &b, &c;
};

[[nodiscard]] Triangle transformed(const glm::mat4x3& world_from_object, const ObjectTriangle& triangle);

struct Intersection {
    double distance_m = 0;
    float u = 0, v = 0;   // barycentric: weights of b and c, within the triangle
    glm::dvec3 normal{};  // (b - a) x (c - a) in the world
};

// REQUIRES: Embree's edge tests say that the ray meets the triangle. Where the ray passes an edge so closely
// that rounding decides, they alone are consistent between the triangles at the edge: so the point is brought
// inside, and never refused. Nothing when the ray runs exactly in the triangle's plane, or starts beyond it.
[[nodiscard]] std::optional<Intersection> intersect(const Ray& ray,
                                                    const glm::mat4x3& world_from_object,
                                                    const ObjectTriangle& triangle);

// How far from the origin of the world the coordinates of the start reach, metres, and some more for rays
// near it.
[[nodiscard]] inline float coordinate_m(const Ray& ray) {
    return std::max({std::abs(ray.origin.x), std::abs(ray.origin.y), std::abs(ray.origin.z)}) + 64;
}

// By how much points on a surface at that distance are off across it, metres: 8 to 16 times the last digit of
// their coordinates, or of the start's, which is no better known. What lies within that is in one place.
[[nodiscard]] inline float rounding_m(const Ray& ray, float distance_m) {
    const glm::vec3 point = ray.origin + ray.direction * distance_m;
    return std::max({std::abs(point.x),
                     std::abs(point.y),
                     std::abs(point.z),
                     std::abs(ray.origin.x),
                     std::abs(ray.origin.y),
                     std::abs(ray.origin.z),
                     1.0f}) *
           0x1p-20f;
}

// How far beyond a limit Embree is asked to look, metres. Grows with the distance.
[[nodiscard]] inline float query_slack(const Ray& ray, float distance_m) {
    return distance_m * 0x1p-12f + coordinate_m(ray) * 0x1p-16f;
}

// What Embree's errors are counted in: some of its roundings.
inline constexpr float embree_rounding = 0x1p-22f;

// By this, metres, hits are compared, and the ends of rays are held against it: the distance; but of a ray
// that grazes the triangle so flatly that Embree's distance could lie beyond it by more than query_slack, so
// much more that it does not. So a limit of order and slack never hides a hit of a lower order: it is found
// whatever was found before. (But for triangles whose normal is mere rounding in single precision: far away
// for their size, and seen from the side.)
[[nodiscard]] float order_of(const Intersection& at,
                             const Ray& ray,
                             const glm::mat4x3& world_from_space,
                             const ObjectTriangle& triangle);

// A hit as Embree offers it, in the space in which it finds it: that of the object, for an instance.
struct EmbreeHit {
    float distance_m;           // in the world
    glm::vec3 direction;        // of the ray; its length is that of a metre of the world
    glm::vec3 normal;           // not unit
    float longest_edge;         // at least that of the triangle
    float farthest_coordinate;  // at least that of its corners
    float spread;               // InstanceShape
};

// Whether the distance that Embree gives is right within half of query_slack, so that order_of is the
// distance. A bound for all triangles of a set, from what is at hand; coarse where the transform stretches.
[[nodiscard]] inline bool is_sure(const Ray& ray, const EmbreeHit& hit) {
    const auto dot = [](const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
    const float speed = std::abs(hit.direction.x) + std::abs(hit.direction.y) + std::abs(hit.direction.z);
    const float transformed =
        2 * hit.spread * ((coordinate_m(ray) + hit.distance_m) * speed + hit.farthest_coordinate);
    const float error = (hit.distance_m * speed + hit.longest_edge + transformed) * embree_rounding;
    const float facing = std::abs(dot(hit.normal, hit.direction));
    const float allowed = query_slack(ray, hit.distance_m) * 0.5f * facing;
    // Squares, without root and division. The normal itself must be more than rounding.
    return error * error * dot(hit.normal, hit.normal) <= allowed * allowed &&
           error * 8 * hit.longest_edge <= facing;
}

// Height of the triangle's plane at a point inside its plan, from its corners alone: the distance along a
// line of kilometres would have lost the digits. Nothing for a vertical triangle.
[[nodiscard]] std::optional<double> height_at(const Triangle& triangle, glm::vec2 at);

// Whether two surfaces that a ray meets are one: in the same place, and even.
[[nodiscard]] bool in_one_plane(const Ray& ray, const Intersection& a, const Intersection& b);

// From a point to the nearest one of the triangle.
[[nodiscard]] double distance_to(const Triangle& triangle, const glm::dvec3& point);

}  // namespace drtv::trace
