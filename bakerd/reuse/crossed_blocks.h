// What the rays of a record, but for the probes' first ones, have to do with the boxes of a change.
#pragma once

#include "bakerd/reuse/boxes.h"
#include "bakerd/reuse/footprint.h"

#include <array>
#include <span>
#include <vector>

namespace drtv::reuse {

// More than any tolerance: nothing is known of how much a change matters.
inline constexpr float unbounded = 1;

class CrossedBlocks {
  public:
    // REQUIRES: the footprint outlives it.
    explicit CrossedBlocks(const Footprint& footprint);

    // By quarter of the sector: the weight of blocks where rays crossed one of the boxes' cells, and that
    // were not counted before.
    [[nodiscard]] std::array<float, quarter_count> add(std::span<const Bounds> boxes);

  private:
    const Footprint& footprint_;
    std::vector<bool> counted_;  // by block
};

}  // namespace drtv::reuse
