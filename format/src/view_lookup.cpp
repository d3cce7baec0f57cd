// Questions that a game asks of a sector where it lies.
#include <drtv/view.h>

#include "position.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace drtv {
namespace {

using Double3 = std::array<double, 3>;

// What is not a number counts as too low.
std::size_t cell_of(double offset, double cell) {
    const double index = std::floor(offset / cell);
    return index > 0 ? static_cast<std::size_t>(std::min(index, double{grid_size - 1})) : 0;
}

double dot(const Double3& a, const Double3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Double3 cross(const Double3& a, const Double3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Of a triangle seen from the origin, signed (van Oosterom and Strackee 1983).
double solid_angle(const Double3& a, const Double3& b, const Double3& c) {
    const double la = std::sqrt(dot(a, a)), lb = std::sqrt(dot(b, b)), lc = std::sqrt(dot(c, c));
    return 2 *
           std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

}  // namespace

Float3 position_m(const SectorView& sector, std::size_t p) {
    return metres_of(units_of(sector, sector.positions[p].position));
}

std::uint8_t find_probe(const SectorView& sector, const Float3& world_m) {
    const StoredGrid& grid = *sector.grid;
    constexpr double width_m = double{sector_size_m} / grid_size;
    const std::size_t x =
        cell_of(static_cast<double>(world_m[0]) - double{sector_size_m} * sector.i, width_m);
    const std::size_t y =
        cell_of(static_cast<double>(world_m[1]) - double{sector_size_m} * sector.j, width_m);
    const std::size_t z = cell_of(
        static_cast<double>(world_m[2]) * position_units_per_m - grid.z_origin_units, grid.cell_height_units);
    const std::uint8_t probe = grid.cells[x + grid_size * y + grid_size * grid_size * z];
    return probe < sector.probe_count ? probe : no_probe;
}

StaticIrradiance static_irradiance_of(const SectorView& sector, std::size_t p) {
    return {sector.static_irradiance[p], sector.static_exponents[p]};
}

LocalPair find_local_pair(const SectorView& sector, std::size_t p, std::size_t s) {
    const std::uint8_t* mask = sector.local_masks.data() + p * sector.local_mask_bytes;
    if ((mask[s / 8] >> (s % 8) & 1) == 0)
        return {};
    // Its place is the number of the receiver's pairs before it.
    std::size_t pair = sector.local_receivers[p].first_pair +
                       static_cast<std::size_t>(
                           std::popcount(static_cast<std::uint8_t>(mask[s / 8] & ((1u << (s % 8)) - 1))));
    for (std::size_t k = 0; k < s / 8; ++k)
        pair += static_cast<std::size_t>(std::popcount(mask[k]));
    return {&sector.local_pairs[pair],
            scale_of_exponent(sector.local_receivers[p].exponent + sector.local_sources[s].exponent)};
}

bool is_inside(const SectorView& sector, const StoredInterior& interior, const Float3& world_m) {
    const auto vertices = sector.interior_vertices.subspan(interior.first_vertex, interior.vertex_count);
    // In steps from the interior's origin.
    Double3 point{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double units =
            static_cast<double>(world_m[axis]) * position_units_per_m - interior.origin_units[axis];
        point[axis] = units / static_cast<double>(1u << interior.shift);
        if (!(point[axis] >= 0 && point[axis] <= UINT16_MAX))
            return false;  // beyond all that steps reach
    }
    double sum = 0;
    for (const auto& triangle :
         sector.interior_triangles.subspan(interior.first_triangle, interior.triangle_count)) {
        std::array<Double3, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                corners[k][axis] = vertices[triangle[k]][axis] - point[axis];
        }
        sum += solid_angle(corners[0], corners[1], corners[2]);
    }
    return std::abs(sum) > 2 * std::numbers::pi;
}

const StoredInterior* find_interior(const SectorView& sector, const Float3& world_m) {
    const auto found =
        std::find_if(sector.interiors.begin(), sector.interiors.end(), [&](const StoredInterior& interior) {
            return is_inside(sector, interior, world_m);
        });
    return found == sector.interiors.end() ? nullptr : &*found;
}

}  // namespace drtv
