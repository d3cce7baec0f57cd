#include "bakerd/reuse/footprint_grid.h"

#include "bakerd/bake/placed_sector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace drtv::reuse {
namespace {

// Measured (docs/measurements.md, "Size and sharpness of the record"): finer cells do not fit into the
// record, coarser ones bake sectors again without need. Height tells most: rays pass above what stands on the
// ground.
constexpr std::int32_t min_cell_m = 16, min_layer_m = 8;
constexpr std::int32_t max_columns = 80, max_layers = 48;
// New things may stand as much higher than all others before they are beyond the grid.
constexpr float headroom_m = 16;

constexpr float half_octave = std::numbers::sqrt2_v<float>;
constexpr std::array<float, max_weight_code - 1> weight_levels = {0x1p-12f,
                                                                  0x1p-12f * half_octave,
                                                                  0x1p-11f,
                                                                  0x1p-11f * half_octave,
                                                                  0x1p-10f,
                                                                  0x1p-10f * half_octave,
                                                                  0x1p-9f,
                                                                  0x1p-9f * half_octave,
                                                                  0x1p-8f,
                                                                  0x1p-7f,
                                                                  0x1p-6f,
                                                                  0x1p-5f,
                                                                  0x1p-4f,
                                                                  0x1p-3f};

}  // namespace

FootprintGrid footprint_grid(map::SectorCoordinate sector, float distance_m, float low_m, float high_m) {
    const double side_m = map::sector_size_m;
    FootprintGrid grid;
    grid.cell_m = min_cell_m;
    while (side_m + 2 * double{distance_m} > static_cast<double>(max_columns - 2) * grid.cell_m)
        grid.cell_m *= 2;
    const auto first = [&](std::int32_t s) {
        return static_cast<std::int32_t>(std::floor((s * side_m - double{distance_m}) / grid.cell_m));
    };
    const auto end = [&](std::int32_t s) {
        return static_cast<std::int32_t>(std::ceil(((s + 1) * side_m + double{distance_m}) / grid.cell_m));
    };
    grid.x = first(sector.i);
    grid.y = first(sector.j);
    grid.columns = end(sector.i) - grid.x;
    grid.rows = end(sector.j) - grid.y;
    if (!(low_m < high_m))
        low_m = high_m = 0;
    low_m -= headroom_m;
    high_m += headroom_m;
    // A block is at least as high as a cell is wide: from a point of a ray to the next it is one block at
    // most (footprint_recorder.cpp).
    grid.layer_m = std::max(min_layer_m, grid.cell_m / 2);
    while (high_m - low_m > static_cast<float>((max_layers - 2) * grid.layer_m))
        grid.layer_m *= 2;
    grid.z = static_cast<std::int32_t>(std::floor(low_m / static_cast<float>(grid.layer_m)));
    grid.layers = static_cast<std::int32_t>(std::ceil(high_m / static_cast<float>(grid.layer_m))) - grid.z;
    return grid;
}

FootprintGrid footprint_grid(map::SectorCoordinate sector,
                             const settings::BakeSettings& settings,
                             bake::World& world) {
    const map::Bounds bounds = world.surroundings(sector, settings).scene->bounds();
    const float distance_m = bake::scene_distance_m(world.placement_tags(), settings);
    return footprint_grid(sector, distance_m, bounds.low.z, bounds.high.z);
}

std::size_t quarter_of(map::SectorCoordinate sector, const placement::Position& probe) {
    constexpr std::int64_t sector_units = std::int64_t{sector_size_m} * position_units_per_m;
    const auto upper = [](std::int64_t units, std::int64_t s) {
        return units >= s * sector_units + sector_units / 2 ? std::size_t{1} : std::size_t{0};
    };
    return upper(probe.y, sector.j) * 2 + upper(probe.x, sector.i);
}

std::uint8_t weight_code(float weight) {
    if (!(weight > 0))
        return 0;
    return static_cast<std::uint8_t>(std::ranges::lower_bound(weight_levels, weight) - weight_levels.begin() +
                                     1);
}

float weight_of_code(std::uint8_t code) {
    if (code == 0)
        return 0;
    return code < max_weight_code ? weight_levels[std::size_t{code} - 1] : 1;
}

}  // namespace drtv::reuse
