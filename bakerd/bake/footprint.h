// What of a map a baked sector depends on (DESIGN, promise 2): where its rays went, with how much weight, and
// where its placement looked. As long as nothing changes there, the sector's file stays the same, byte for
// byte (assessment.h).
#pragma once

#include "bakerd/map/ground.h"
#include "placement/placement.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace drtv::bake {

// Of what a record says, and how: results whose record is of another version are never candidates.
inline constexpr std::uint32_t footprint_version = 4;

// The space around a sector, as far as its rays go, in cells that are aligned to the world: columns side by
// side, at most 64 layers high, some way above and below what stands there. Where it ends upwards and
// downwards, rays go on unseen. Weights are kept of blocks of 2 x 2 x 2 cells.
struct FootprintGrid {
    std::int32_t cell_m = 0, layer_m = 0;  // width and height of a cell, powers of two
    std::int32_t x = 0, y = 0, z = 0;  // the first cell, counted in cells and layers from the world's origin
    std::int32_t columns = 0, rows = 0, layers = 0;

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
        return (static_cast<std::size_t>(j >> 1) * static_cast<std::size_t>((columns + 1) >> 1) +
                static_cast<std::size_t>(i >> 1)) *
                   static_cast<std::size_t>((layers + 1) >> 1) +
               static_cast<std::size_t>(layer >> 1);
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

// Probes of a quarter of the sector share their weights: what many of them hardly see, some see well.
inline constexpr std::size_t quarter_count = 4;
[[nodiscard]] std::size_t quarter_of(map::SectorCoordinate sector, const placement::Position& probe);

// Layers of a column, one bit each from the lowest, from one to another, both counted.
[[nodiscard]] constexpr std::uint64_t layers_between(std::int32_t low, std::int32_t high) {
    return (~std::uint64_t{0} >> (63 - (high - low))) << low;
}

// A weight in four bits, rounded up: 0 means never crossed, then from 2^-12 by half powers of two to 2^-8,
// where tolerances lie, and by whole ones to 2^-3; 15 is more than can be told.
inline constexpr std::uint8_t most_weight_code = 15;
[[nodiscard]] std::uint8_t weight_code(float weight);
[[nodiscard]] float weight_of_code(std::uint8_t code);

// Coefficients of static light have no bound of their own. Changes of theirs count against this: E/pi in
// W/m2, what some 500 lux make of a white surface.
inline constexpr float static_irradiance_range = 0.25f;

// A point of which placement asked whether it stands in a solid.
struct SolidTest {
    placement::Position position;
    std::uint8_t to_flip = 0;  // rays that would have to end otherwise for the answer to change

    bool operator==(const SolidTest&) const = default;
};

// What is known of a probe beyond what its file says.
struct ProbeRecord {
    placement::Position position{};
    // Its share of the file's statistics.
    std::uint32_t rays = 0, shadow_rays = 0, back_hits = 0;
    float error = 0;
    // Of its paths' weight, what may have changed since it was baked; above 0 of one that was taken over from
    // another map within a tolerance. Times the gain it bounds how far its coefficients are off.
    float share = 0;

    bool operator==(const ProbeRecord&) const = default;
};

struct Footprint {
    map::SectorCoordinate sector;
    float reach_m = 0;
    std::uint32_t rays = 0;  // from each probe
    // Nothing is known of how much a change would matter: local transfer, or a number of rays that follows
    // from what they find.
    bool without_bounds = false;
    // The most that a path can bring from static lights, over static_irradiance_range (static_gain.h); 0
    // where there are none. Of all maps whose probes are here.
    float static_gain = 0;
    float most_scattered = 1;  // of their surfaces (trace::most_scattered), above 0
    float placement_m = 0;     // how far around the sector placement looked down its columns
    float min_distance_m = 0;  // between probes

    std::vector<ProbeRecord> probes;
    // Where rays went; the probes' first ones need no record: they follow from where the probes stand.
    FootprintGrid grid;
    std::vector<std::uint64_t> crossed;  // by column: its layers that a ray crossed
    std::vector<std::uint8_t>
        weights;  // by block and quarter: the largest share in a coefficient of a probe, as a code
    std::vector<SolidTest> solid_tests;  // sorted

    bool operator==(const Footprint&) const = default;

    // What a path's weight counts: the sky's radiance is 1.
    [[nodiscard]] float gain() const { return static_gain < 1 ? 1 : static_gain; }
    // On how far any coefficient is off.
    [[nodiscard]] float bound() const {
        float share = 0;
        for (const ProbeRecord& probe : probes)
            share = share < probe.share ? probe.share : share;
        return share * gain();
    }
    [[nodiscard]] std::uint8_t weight(std::size_t block, std::size_t quarter) const {
        return weights[block * quarter_count + quarter];
    }
};

// What is stored of it; where it would be larger than this, its smallest weights are raised until it is not,
// if they can make it so.
inline constexpr std::size_t most_record_bytes = std::size_t{16} << 10;
[[nodiscard]] std::vector<std::uint8_t> encode_footprint(const Footprint& footprint);
// Nothing when the bytes are not such.
[[nodiscard]] std::optional<Footprint> decode_footprint(std::span<const std::uint8_t> bytes);

}  // namespace drtv::bake
