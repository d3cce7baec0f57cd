// Questions that a game asks of a sector where it lies.
#include <drtv/view.h>

#include "position.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

namespace drtv {
namespace {

using Double3 = std::array<double, 3>;

template <class Number>
Double3 double3_of(const std::array<Number, 3>& v) {
    Double3 result;
    std::ranges::copy(v, result.begin());
    return result;
}

// What is not a number counts as too low.
std::size_t cell_of(double offset, double cell) {
    const double index = std::floor(offset / cell);
    if (!(index > 0))
        return 0;
    return static_cast<std::size_t>(std::min(index, double{grid_size - 1}));
}

double dot(const Double3& a, const Double3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double length(const Double3& v) {
    return std::sqrt(dot(v, v));
}
Double3 cross(const Double3& a, const Double3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Double3 subtract(const Double3& a, const Double3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// Of a triangle seen from the origin, signed (van Oosterom and Strackee 1983).
double solid_angle(const Double3& a, const Double3& b, const Double3& c) {
    const double la = length(a);
    const double lb = length(b);
    const double lc = length(c);
    const double numerator = dot(a, cross(b, c));
    const double denominator = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    return 2 * std::atan2(numerator, denominator);
}

// In steps from the interior's origin; nothing beyond all that steps reach.
std::optional<Double3> point_in_steps(const StoredInterior& interior, const Float3& world_m) {
    const double units_per_step = 1u << interior.shift;
    Double3 point = double3_of(world_m);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double units = point[axis] * position_units_per_m - interior.origin_units[axis];
        point[axis] = units / units_per_step;
        const bool within = point[axis] >= 0 && point[axis] <= UINT16_MAX;
        if (!within)
            return std::nullopt;
    }
    return point;
}

// How many of the receiver's pairs come before that with source `s`.
std::size_t count_pairs_before(const std::uint8_t* mask, std::size_t s) {
    const unsigned earlier_bits = (1u << (s % 8)) - 1;
    int count = std::popcount(mask[s / 8] & earlier_bits);
    for (std::size_t k = 0; k < s / 8; ++k)
        count += std::popcount(mask[k]);
    return static_cast<std::size_t>(count);
}

}  // namespace

Float3 position_m(const SectorView& sector, std::size_t p) {
    return metres_of(units_of(sector, sector.positions[p].position));
}

std::uint8_t find_probe(const SectorView& sector, const Float3& world_m) {
    const StoredGrid& grid = *sector.grid;
    constexpr double side_m = sector_size_m;
    constexpr double width_m = side_m / grid_size;
    const auto [world_x, world_y, world_z] = double3_of(world_m);
    const double height_units = world_z * position_units_per_m - grid.z_origin_units;
    const std::size_t x = cell_of(world_x - side_m * sector.i, width_m);
    const std::size_t y = cell_of(world_y - side_m * sector.j, width_m);
    const std::size_t z = cell_of(height_units, grid.cell_height_units);
    const std::size_t cell = x + grid_size * y + grid_size * grid_size * z;
    const std::uint8_t probe = grid.cells[cell];
    return probe < sector.probe_count ? probe : no_probe;
}

StaticIrradiance static_irradiance_of(const SectorView& sector, std::size_t p) {
    return {sector.static_irradiance[p], sector.static_exponents[p]};
}

LocalPair find_local_pair(const SectorView& sector, std::size_t p, std::size_t s) {
    const std::uint8_t* mask = sector.local_masks.data() + p * sector.local_mask_bytes;
    const bool is_pair = (mask[s / 8] >> (s % 8) & 1) != 0;
    if (!is_pair)
        return {};
    const StoredReceiver& receiver = sector.local_receivers[p];
    const LocalSource& source = sector.local_sources[s];
    const std::size_t pair = receiver.first_pair + count_pairs_before(mask, s);
    return {&sector.local_pairs[pair], scale_of_exponent(receiver.exponent + source.exponent)};
}

bool is_inside(const SectorView& sector, const StoredInterior& interior, const Float3& world_m) {
    const auto point = point_in_steps(interior, world_m);
    if (!point)
        return false;
    const auto vertices = sector.interior_vertices.subspan(interior.first_vertex, interior.vertex_count);
    const auto triangles =
        sector.interior_triangles.subspan(interior.first_triangle, interior.triangle_count);
    const auto corner = [&](std::uint16_t v) { return subtract(double3_of(vertices[v]), *point); };
    double sum = 0;
    for (const auto& [a, b, c] : triangles)
        sum += solid_angle(corner(a), corner(b), corner(c));
    return std::abs(sum) > 2 * std::numbers::pi;
}

const StoredInterior* find_interior(const SectorView& sector, const Float3& world_m) {
    for (const StoredInterior& interior : sector.interiors) {
        if (is_inside(sector, interior, world_m))
            return &interior;
    }
    return nullptr;
}

}  // namespace drtv
