// The spaces of a sector between its surfaces, on vertical lines 2 m apart: which of them are the inside of a
// solid, or lie under the ground and are sealed. From a sealed space nothing of the sector is seen.
#pragma once

#include "placement/disjoint_sets.h"
#include "placement/placement.h"

#include <glm/vec2.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace drtv::placement {

class Spaces {
  public:
    static constexpr std::int32_t lines_along = 32;

    // `corner` is the sector's; what a probe stands in is not sealed. Nothing is asked beyond the sector:
    // what changes there does not change its grid. REQUIRES: the queries outlive it.
    Spaces(const Position& corner,
           float bottom_m,
           float top_m,
           std::span<const glm::vec3> probes,
           const SceneQueries& queries);

    [[nodiscard]] glm::vec2 line_at(std::int32_t x, std::int32_t y) const;

    // From a height on a line, out of the solid that holds it if need be; nothing where that ends at `top_m`.
    [[nodiscard]] std::optional<float> free_height(std::int32_t x, std::int32_t y, float z_m, float top_m);

  private:
    // Part of a line between two surfaces: all of it is in one space.
    struct Interval {
        float low_m = 0, high_m = 0;  // within the heights that matter
        bool under_back = false;      // the next surface above it that is of no body is seen from its back
        bool under_body = false;      // some body is above
        bool open = false;            // of a space: it leads to others that are under none, or holds a probe
    };
    struct Line {
        std::vector<ColumnHit> hits;           // from the bottom up
        std::vector<std::uint32_t> intervals;  // by the number of surfaces below
    };

    void add_line(std::int32_t x, std::int32_t y, float bottom_m, float top_m);
    void join_neighbours();
    void join(std::int32_t x, std::int32_t y, std::int32_t other_x, std::int32_t other_y);
    // By a straight way between the two places.
    void join(std::uint32_t a, const glm::vec3& in_a, std::uint32_t b, const glm::vec3& in_b);
    [[nodiscard]] static std::size_t surfaces_below(const Line& line, float z_m);
    [[nodiscard]] bool is_in_solid(const Line& line, const glm::vec2& at, std::size_t below, float z_m);
    void open_at(const glm::vec3& place);
    [[nodiscard]] const Line& line(std::int32_t x, std::int32_t y) const {
        return lines_[static_cast<std::size_t>(y * lines_along + x)];
    }

    const Position corner_;
    const SceneQueries& queries_;
    std::vector<Line> lines_;  // by row
    std::vector<Interval> intervals_;
    DisjointSets spaces_;                      // of intervals; what is said of a space stands at its first
    std::vector<std::optional<bool>> closed_;  // by interval: inside closed surfaces
};

}  // namespace drtv::placement
