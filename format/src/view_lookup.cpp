// Questions that a game asks of a sector where it lies.
#include <drtv/view.h>

#include "bytes.h"
#include "position.h"

#include <algorithm>
#include <bit>
#include <cmath>
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

// What is not a number counts as too low.
std::size_t cell_of(double offset, double cell) {
    const double index = std::floor(offset / cell);
    if (!(index > 0))
        return 0;
    return static_cast<std::size_t>(std::min(index, double{grid_size - 1}));
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
std::optional<Vector> point_in_steps(const StoredInterior& interior, const Float3& world_m) {
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

// How many of the receiver's pairs come before that with source `s`.
std::size_t count_pairs_before(const std::uint8_t* mask, std::size_t s) {
    constexpr std::size_t word_bits = 64;
    const auto word = [mask](std::size_t n) { return load_u64({mask, 8 * n + 8}, 8 * n); };
    const std::uint64_t earlier_bits = (std::uint64_t{1} << (s % word_bits)) - 1;
    int count = std::popcount(word(s / word_bits) & earlier_bits);
    for (std::size_t n = 0; n < s / word_bits; ++n)
        count += std::popcount(word(n));
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
    const auto [world_x, world_y, world_z] = vector_of(world_m);
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

std::optional<std::size_t> find_light_group(const SectorView& sector, std::string_view name) {
    for (std::size_t g = 0; g < sector.light_group_names.size(); ++g) {
        if (light_group_name(sector, g) == name)
            return g;
    }
    return std::nullopt;
}

std::string_view light_group_name(const SectorView& sector, std::size_t g) {
    return sector.light_group_names[g].data();
}

StaticIrradiance light_group_irradiance_of(const SectorView& sector, std::size_t g, std::size_t p) {
    const std::size_t n = g * sector.probe_count + p;
    return {sector.light_group_irradiance[n], sector.light_group_exponents[n]};
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
    const auto corner = [&](std::uint16_t v) { return vector_of(vertices[v]) - *point; };
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
