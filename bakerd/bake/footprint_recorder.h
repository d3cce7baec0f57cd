// Notes which cells the rays of a sector cross while it is baked. Not thread-safe: one for each thread,
// merged in the end.
#pragma once

#include "bakerd/bake/footprint.h"
#include "bakerd/trace/scene.h"

#include <drtv/conventions.h>
#include <tbb/enumerable_thread_specific.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace drtv::bake {

// What a change can alter at most, as a share of the range of coefficients: for each basis direction, since
// their coefficients are told apart.
using Shares = std::array<float, basis_count>;

class FootprintRecorder {
  public:
    explicit FootprintRecorder(const FootprintGrid& grid);

    // What follows is another probe's, which stands in that quarter: shares add up within one, and the
    // largest of all counts.
    void begin(std::size_t quarter);

    // A part of the path of that number, as far as `length_m`: a change anywhere on it changes what the path
    // brings by at most `shares`. Of a path's parts the first through a block counts alone: later ones weigh
    // less (trace::most_scattered).
    void path(const trace::Ray& ray, float length_m, const Shares& shares, std::uint32_t number);

    // A ray whose shares are its own, as that to a light.
    void lone(const trace::Ray& ray, const Shares& shares);

    // Of each column all layers of both, of each block the larger code. REQUIRES: the footprint is of the
    // same grid.
    void merge_into(Footprint& footprint);

  private:
    // Shares, 16 bits each in units of 2^-18: a sector's blocks should stay in the caches. They saturate
    // beyond what weights can tell.
    using Units = std::uint64_t;

    [[nodiscard]] static Units units_of(const Shares& shares);
    void count(std::size_t block, Units units);

    // Gives the blocks that the ray crosses, each once; they stand until the next call.
    [[nodiscard]] std::span<const std::int32_t> cross(const trace::Ray& ray, float length_m);
    void fold();
    void cross_corners();

    const FootprintGrid grid_;
    std::vector<std::uint64_t> crossed_;  // by column; with a border of one, where a walk may end by rounding
    std::vector<std::uint32_t> seen_;     // by block: by which path last
    std::vector<Units> shares_;           // by block: of the probe at work
    std::array<std::vector<Units>, quarter_count> most_;  // by block: the largest of the probes before
    std::vector<std::int32_t> list_;                      // of a ray's blocks
    // Columns that rays passed at a corner, and their layers, highest x 256 + lowest. Many in one go: a
    // branch at each would cost more than all the rest.
    std::vector<std::int32_t> corner_columns_, corner_layers_;
    std::size_t corners_ = 0;
    std::size_t quarter_ = 0;
    std::optional<std::uint32_t> number_;  // of the probe's path at work
    std::uint32_t path_ = 0;               // the same, of all probes
};

// One for each thread that asks.
class FootprintRecorders {
  public:
    explicit FootprintRecorders(const FootprintGrid& grid) : grid_(grid), recorders_(grid) {}

    [[nodiscard]] FootprintRecorder& of_this_thread() { return recorders_.local(); }

    // What all threads noted. REQUIRES: no thread is recording.
    void store(Footprint& footprint) {
        footprint.grid = grid_;
        footprint.crossed.assign(grid_.column_count(), 0);
        footprint.weights.assign(grid_.block_count() * quarter_count, 0);
        merge_into(footprint);
    }

    // REQUIRES: besides, the footprint is of the same grid.
    void merge_into(Footprint& footprint) {
        for (FootprintRecorder& recorder : recorders_)
            recorder.merge_into(footprint);
    }

  private:
    const FootprintGrid grid_;
    tbb::enumerable_thread_specific<FootprintRecorder> recorders_;
};

}  // namespace drtv::bake
