// Notes which cells the rays of a sector cross while it is baked.
#pragma once

#include "bakerd/bake/ray_watch.h"
#include "bakerd/reuse/cell_walk.h"
#include "bakerd/reuse/footprint.h"

#include <tbb/enumerable_thread_specific.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace drtv::reuse {

// Not thread-safe: one for each thread, merged in the end.
class FootprintRecorder final : public bake::RayWatch {
  public:
    FootprintRecorder(map::SectorCoordinate sector, const FootprintGrid& grid);

    // Shares add up within a probe, and of the probes of a quarter the largest counts.
    void begin_probe(const glm::ivec3& position_units) override;

    // Of a path's parts the first through a block counts alone: later ones weigh less
    // (trace::max_scattered).
    void record_segments(std::span<const bake::PathSegment> segments) override;

    void record_shadow_rays(std::span<const bake::ShadowRay> rays) override;

    // Of each column all layers of both, of each block the larger code. REQUIRES: the footprint is of the
    // same grid.
    void merge_into(Footprint& footprint);

  private:
    // Shares, 16 bits each in units of 2^-18: a sector's blocks should stay in the caches. They saturate
    // beyond what weights can tell.
    using Units = std::uint64_t;

    [[nodiscard]] static Units units_of(const bake::Shares& shares);
    void count(std::size_t block, Units units);
    void end_probe();

    const map::SectorCoordinate sector_;
    const FootprintGrid grid_;
    CellWalk walk_;
    std::vector<std::uint32_t> seen_;                        // by block: by which path last
    std::vector<Units> shares_;                              // by block: of the probe at work
    std::array<std::vector<Units>, quarter_count> largest_;  // by block: of the probes before
    std::size_t quarter_ = 0;                                // of the probe at work
    std::optional<std::uint32_t> number_;                    // of its path at work
    std::uint32_t path_ = 0;                                 // the same, counted over all probes
};

// One for each thread that asks.
class FootprintRecorders {
  public:
    FootprintRecorders(map::SectorCoordinate sector, const FootprintGrid& grid)
        : grid_(grid), recorders_(sector, grid) {}

    [[nodiscard]] FootprintRecorder& of_this_thread() { return recorders_.local(); }

    // What all threads noted. REQUIRES: no thread is recording.
    void store(Footprint& footprint);

    // REQUIRES: besides, the footprint is of the same grid.
    void merge_into(Footprint& footprint);

  private:
    const FootprintGrid grid_;
    tbb::enumerable_thread_specific<FootprintRecorder> recorders_;
};

}  // namespace drtv::reuse
