// Whether a change can move a sector's probes.
#pragma once

#include "bakerd/reuse/boxes.h"
#include "bakerd/reuse/footprint.h"
#include "bakerd/reuse/inventory.h"
#include "bakerd/reuse/verdict.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace drtv::reuse {

// Of a thing that is in one map alone: why placement, which certainly asked about its place, may come out
// otherwise.
[[nodiscard]] std::optional<Cause> moves_probes(const Item& item, const Footprint& footprint);

// The tests for solids on which a placement rests. Each sends rays, and its answer holds until so many of
// them may end otherwise.
class SolidTestChanges {
  public:
    // REQUIRES: the footprint outlives it.
    explicit SolidTestChanges(const Footprint& footprint);

    // Counts the rays that meet one of the boxes in which something changed, each once. Whether an answer may
    // change.
    [[nodiscard]] bool add(std::span<const Bounds> boxes);

    // By test: the rays counted so far.
    [[nodiscard]] std::vector<std::uint8_t> counts() const;

  private:
    const Footprint& footprint_;
    std::vector<std::uint32_t> rays_;  // by test: those counted, a bit for each direction
};

}  // namespace drtv::reuse
