// The cells in which a record says where the rays of a sector went.
#pragma once

#include "bakerd/bake/world.h"
#include "bakerd/map/ground.h"
#include "placement/placement.h"
#include "settings/bake_settings.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>

namespace drtv::reuse {

// The space around a sector, as far as its rays go, in cells that are aligned to the world: columns side by
// side, at most 64 layers high, some way above and below what stands there. Where it ends upwards and
// downwards, rays go on unseen. Weights are kept of blocks of 2 x 2 x 2 cells.
struct FootprintGrid {
    // Width and height of a cell, powers of two.
    std::int32_t cell_m = 0;
    std::int32_t layer_m = 0;
    // The first cell, counted in cells and layers from the world's origin.
    std::int32_t x = 0;
    std::int32_t y = 0;
    std::int32_t z = 0;
    std::int32_t columns = 0;
    std::int32_t rows = 0;
    std::int32_t layers = 0;

    bool operator==(const FootprintGrid&) const = default;
    [[nodiscard]] std::size_t column_count() const {
        return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    }
    [[nodiscard]] std::size_t column(std::int32_t i, std::int32_t j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i);
    }
    [[nodiscard]] std::size_t block_count() const { return block(0, (rows + 1) & ~1, 0); }
    // Of a cell.
    [[nodiscard]] std::size_t block(std::int32_t i, std::int32_t j, std::int32_t layer) const {
        const auto half = [](std::int32_t cells) { return static_cast<std::size_t>(cells >> 1); };
        const std::size_t stack = half(j) * half(columns + 1) + half(i);
        return stack * half(layers + 1) + half(layer);
    }
    // World metres.
    [[nodiscard]] glm::vec3 low() const { return {x * cell_m, y * cell_m, z * layer_m}; }
    [[nodiscard]] glm::vec3 high() const {
        return {(x + columns) * cell_m, (y + rows) * cell_m, (z + layers) * layer_m};
    }
};

// Covers `distance_m` around the sector; `low_m` and `high_m` are the heights of the scene.
[[nodiscard]] FootprintGrid footprint_grid(map::SectorCoordinate sector,
                                           float distance_m,
                                           float low_m,
                                           float high_m);

// Covers all that a bake of the sector looks at.
[[nodiscard]] FootprintGrid footprint_grid(map::SectorCoordinate sector,
                                           const settings::BakeSettings& settings,
                                           bake::World& world);

// Probes of a quarter of the sector share their weights: what many of them hardly see, some see well.
inline constexpr std::size_t quarter_count = 4;
[[nodiscard]] std::size_t quarter_of(map::SectorCoordinate sector, const placement::Position& probe);

// Layers of a column, one bit each from the lowest, from one to another, both counted.
[[nodiscard]] constexpr std::uint64_t layers_between(std::int32_t low, std::int32_t high) {
    return (~std::uint64_t{0} >> (63 - (high - low))) << low;
}

// A weight in four bits, rounded up: 0 means never crossed, then from 2^-12 by half powers of two to 2^-8,
// where tolerances lie, and by whole ones to 2^-3; 15 is more than can be told.
inline constexpr std::uint8_t max_weight_code = 15;
[[nodiscard]] std::uint8_t weight_code(float weight);
[[nodiscard]] float weight_of_code(std::uint8_t code);

}  // namespace drtv::reuse
