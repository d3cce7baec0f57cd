// Which cells of a grid rays cross. Fast, since every ray of a bake is walked: eight points of a ray at a
// time.
#pragma once

#include "bakerd/reuse/boxes.h"
#include "bakerd/reuse/footprint_grid.h"
#include "bakerd/trace/ray.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace drtv::reuse {

class CellWalk {
  public:
    explicit CellWalk(const FootprintGrid& grid);

    // Notes the cells that the ray crosses up to `length_m`, and gives their blocks, each once. They stand
    // until the next call. Blocks of cells beyond the border, where rounding may lead, are below
    // block_count().
    [[nodiscard]] std::span<const std::int32_t> cross(const trace::Ray& ray, float length_m);

    [[nodiscard]] std::size_t block_count() const;

    // Adds the layers noted so far to those of each column of the grid.
    void merge_into(std::vector<std::uint64_t>& crossed);

  private:
    [[nodiscard]] RayPart within_heights(const trace::Ray& ray, float length_m) const;
    void make_room(std::size_t points);
    void note_corners();

    const FootprintGrid grid_;
    std::vector<std::uint64_t> crossed_;  // by column; with a border of one, where a walk may end by rounding
    std::vector<std::int32_t> blocks_;    // of a ray
    // Columns that rays passed at a corner, and their layers, highest x 256 + lowest. Many in one go: a
    // branch at each would cost more than all the rest.
    std::vector<std::int32_t> corner_columns_;
    std::vector<std::int32_t> corner_layers_;
    std::size_t corners_ = 0;
};

}  // namespace drtv::reuse
