// Questions that a game asks of a sector where it lies.
#include <drtv/view.h>

#include "bytes.h"
#include "position.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

namespace drtv {
namespace {

// What is not a number counts as too low.
std::size_t cell_of(double offset, double cell) {
    const double index = std::floor(offset / cell);
    if (!(index > 0))
        return 0;
    return static_cast<std::size_t>(std::min(index, double{grid_size - 1}));
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

Double3 exact_position_m(const SectorView& sector, std::size_t p) {
    const Units3 units = units_of(sector, sector.positions[p].position);
    return {units[0] * double{position_unit_m},
            units[1] * double{position_unit_m},
            units[2] * double{position_unit_m}};
}

std::uint8_t find_probe(const SectorView& sector, const Double3& world_m) {
    const StoredGrid& grid = *sector.grid;
    constexpr double side_m = sector_size_m;
    constexpr double width_m = side_m / grid_size;
    const auto [world_x, world_y, world_z] = world_m;
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

}  // namespace drtv
