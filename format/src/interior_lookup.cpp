// Where a place lies beside the closed meshes of interiors.
#include <drtv/view.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace drtv {
namespace {

struct Vector {
    double x;
    double y;
    double z;
};

template <class Number>
Vector vector_of(const std::array<Number, 3>& v) {
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

Vector operator-(const Vector& a, const Vector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
double dot(const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
double length(const Vector& v) {
    return std::sqrt(dot(v, v));
}
Vector cross(const Vector& a, const Vector& b) {
    const double x = a.y * b.z - a.z * b.y;
    const double y = a.z * b.x - a.x * b.z;
    const double z = a.x * b.y - a.y * b.x;
    return {x, y, z};
}

// Of a triangle seen from the origin, signed (van Oosterom and Strackee 1983).
double solid_angle(const Vector& a, const Vector& b, const Vector& c) {
    const double la = length(a);
    const double lb = length(b);
    const double lc = length(c);
    const double numerator = dot(a, cross(b, c));
    const double denominator = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    return 2 * std::atan2(numerator, denominator);
}

bool is_step(double steps) {
    return steps >= 0 && steps <= UINT16_MAX;
}

// In steps from the interior's origin; nothing beyond all that steps reach.
std::optional<Vector> point_in_steps(const StoredInterior& interior, const Double3& world_m) {
    const double units_per_step = 1u << interior.shift;
    const auto steps_of = [&](double metres, std::int32_t origin_units) {
        const double units = metres * position_units_per_m - origin_units;
        return units / units_per_step;
    };
    const auto [x_m, y_m, z_m] = vector_of(world_m);
    const auto [origin_x, origin_y, origin_z] = interior.origin_units;
    Vector point;
    point.x = steps_of(x_m, origin_x);
    point.y = steps_of(y_m, origin_y);
    point.z = steps_of(z_m, origin_z);
    if (!is_step(point.x) || !is_step(point.y) || !is_step(point.z))
        return std::nullopt;
    return point;
}

// Squared distance from the origin to a triangle, by the region in which the nearest point lies (C. Ericson,
// "Real-Time Collision Detection", 2005, section 5.1.5).
double squared_distance_to_triangle(const Vector& a, const Vector& b, const Vector& c) {
    const Vector ab = b - a;
    const Vector ac = c - a;
    const double d1 = -dot(ab, a);
    const double d2 = -dot(ac, a);
    if (d1 <= 0 && d2 <= 0)
        return dot(a, a);
    const double d3 = -dot(ab, b);
    const double d4 = -dot(ac, b);
    if (d3 >= 0 && d4 <= d3)
        return dot(b, b);
    const double d5 = -dot(ab, c);
    const double d6 = -dot(ac, c);
    if (d6 >= 0 && d5 <= d6)
        return dot(c, c);
    const auto at = [&](double v, double w) {
        const Vector p = {a.x + v * ab.x + w * ac.x, a.y + v * ab.y + w * ac.y, a.z + v * ab.z + w * ac.z};
        return dot(p, p);
    };
    const double on_c = d1 * d4 - d3 * d2;
    if (on_c <= 0 && d1 >= 0 && d3 <= 0)
        return at(d1 / (d1 - d3), 0);
    const double on_b = d5 * d2 - d1 * d6;
    if (on_b <= 0 && d2 >= 0 && d6 <= 0)
        return at(0, d2 / (d2 - d6));
    const double on_a = d3 * d6 - d5 * d4;
    if (on_a <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return at(1 - w, w);
    }
    const double sum = on_a + on_b + on_c;
    return at(on_b / sum, on_c / sum);
}

// The interior's vertices and triangles.
struct Mesh {
    std::span<const std::array<std::uint16_t, 3>> vertices;
    std::span<const std::array<std::uint16_t, 3>> triangles;
};
Mesh mesh_of(const SectorView& sector, const StoredInterior& interior) {
    return {sector.interior_vertices.subspan(interior.first_vertex, interior.vertex_count),
            sector.interior_triangles.subspan(interior.first_triangle, interior.triangle_count)};
}

double metres_per_step(const StoredInterior& interior) {
    const double units = 1u << interior.shift;
    return units / position_units_per_m;
}

}  // namespace

bool is_inside(const SectorView& sector, const StoredInterior& interior, const Double3& world_m) {
    const auto point = point_in_steps(interior, world_m);
    if (!point)
        return false;
    const auto [vertices, triangles] = mesh_of(sector, interior);
    const auto corner = [&, vertices = vertices](std::uint16_t v) { return vector_of(vertices[v]) - *point; };
    double sum = 0;
    for (const auto& [a, b, c] : triangles)
        sum += solid_angle(corner(a), corner(b), corner(c));
    return std::abs(sum) > 2 * std::numbers::pi;
}

const StoredInterior* find_interior(const SectorView& sector, const Double3& world_m) {
    for (const StoredInterior& interior : sector.interiors) {
        if (is_inside(sector, interior, world_m))
            return &interior;
    }
    return nullptr;
}

InteriorBounds bounds_of(const SectorView& sector, const StoredInterior& interior) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    InteriorBounds bounds{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const auto& vertex : mesh_of(sector, interior).vertices) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double origin_m = double{position_unit_m} * interior.origin_units[axis];
            const double at = origin_m + vertex[axis] * metres_per_step(interior);
            bounds.low[axis] = std::min(bounds.low[axis], at);
            bounds.high[axis] = std::max(bounds.high[axis], at);
        }
    }
    return bounds;
}

double signed_distance_m(const SectorView& sector, const StoredInterior& interior, const Double3& world_m) {
    const auto [vertices, triangles] = mesh_of(sector, interior);
    const double step_m = metres_per_step(interior);
    const auto corner = [&, vertices = vertices](std::uint16_t v) {
        Double3 from_place;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double origin_m = double{position_unit_m} * interior.origin_units[axis];
            from_place[axis] = origin_m - world_m[axis] + vertices[v][axis] * step_m;
        }
        return vector_of(from_place);
    };
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : triangles) {
        const double squared = squared_distance_to_triangle(corner(a), corner(b), corner(c));
        if (squared < least)  // a triangle without an area may give no number
            least = squared;
    }
    const double distance = std::sqrt(least);
    return is_inside(sector, interior, world_m) ? distance : -distance;
}

}  // namespace drtv
