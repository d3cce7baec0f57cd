#include "placement/grid.h"

#include "placement/spaces.h"
#include "placement/units.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <compare>
#include <functional>
#include <optional>
#include <utility>

namespace drtv::placement {
namespace {

constexpr auto cells_along = static_cast<std::int32_t>(grid_size);
constexpr std::int32_t side = sector_size_m * units_per_m;
constexpr std::int32_t cell_width = side / cells_along;
static_assert(Spaces::lines_along == 2 * cells_along);
constexpr std::int32_t margin_units = 2 * units_per_m;  // below the lowest and above the highest probe

// Four corners of a cube that no two share an edge of, east, north and up: where the cell's points stand.
struct Corner {
    std::int32_t east, north, up;
};
constexpr std::array<Corner, 4> corners = {{{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}}};

// Sets the vertical extent.
void span_probes(std::span<const GridProbe> probes, ProbeGrid& grid) {
    const auto by_height = [](const GridProbe& a, const GridProbe& b) { return a.position.z < b.position.z; };
    const auto [lowest, highest] = std::minmax_element(probes.begin(), probes.end(), by_height);
    const std::int32_t bottom = lowest->position.z - margin_units;
    const std::int32_t top = highest->position.z + margin_units;
    const std::int32_t height = std::max(units_per_m, (top - bottom + 15) / 16);
    grid.z_origin_units = bottom;
    grid.cell_height_units = static_cast<std::uint32_t>(height);
}

class GridBuild {
  public:
    GridBuild(std::int32_t i, std::int32_t j, std::span<const GridProbe> probes, const SceneQueries& queries)
        : probes_(probes), queries_(queries) {
        grid_.cells.fill(no_probe);
        if (probes.empty())
            return;
        span_probes(probes, grid_);
        corner_ = {i * side, j * side, grid_.z_origin_units};
        for (const GridProbe& probe : probes)
            places_.push_back(metres(probe.position));
    }

    ProbeGrid run() {
        if (probes_.empty())
            return grid_;
        const float bottom_m = metres(corner_).z;
        const float top_m = metres(corner_ + Position(0, 0, cells_along * cell_height())).z;
        spaces_.emplace(Position(corner_.x, corner_.y, 0), bottom_m, top_m, places_, queries_);
        std::size_t cell = 0;
        for (std::int32_t z = 0; z < cells_along; ++z) {
            for (std::int32_t y = 0; y < cells_along; ++y) {
                for (std::int32_t x = 0; x < cells_along; ++x)
                    grid_.cells[cell++] = probe_for({x, y, z});
            }
        }
        return grid_;
    }

  private:
    // Squares of distances, nearest first.
    struct Near {
        std::int64_t squared_units;
        std::uint8_t probe;
        auto operator<=>(const Near&) const = default;
    };
    using Hides = std::function<bool(const glm::vec3&, const glm::vec3&)>;

    std::uint8_t probe_for(const Position& cell) {
        find_points(cell);
        order_probes(cell);
        if (order_.empty())
            return no_probe;
        if (points_.empty()) {
            ++grid_.buried_cells;
            return std::ranges::min(order_).probe;
        }
        if (const auto seen = best_seen(queries_.hidden))
            return *seen;
        ++grid_.blind_cells;
        return best_seen(queries_.separated).value_or(std::ranges::min(order_).probe);
    }

    [[nodiscard]] std::int32_t cell_height() const {
        return static_cast<std::int32_t>(grid_.cell_height_units);
    }

    // Sets the cell's points, and those that count.
    void find_points(const Position& cell) {
        points_.clear();
        all_points_.clear();
        const std::int32_t height = cell_height();
        const float top_m = metres({0, 0, corner_.z + (cell.z + 1) * height}).z;
        for (const auto& [east, north, up] : corners) {
            const std::int32_t x = 2 * cell.x + east;
            const std::int32_t y = 2 * cell.y + north;
            const std::int32_t z = cell.z * height + (up != 0 ? height - height / 4 : height / 4);
            const float z_m = metres({0, 0, corner_.z + z}).z;
            all_points_.emplace_back(spaces_->line_at(x, y), z_m);
            if (const auto free_m = spaces_->free_height(x, y, z_m, top_m))
                points_.emplace_back(spaces_->line_at(x, y), *free_m);
        }
    }

    // Sets the probes that the cell may name.
    void order_probes(const Position& cell) {
        const std::int32_t height = cell_height();
        const Position centre = corner_ + Position(cell.x * cell_width + cell_width / 2,
                                                   cell.y * cell_width + cell_width / 2,
                                                   cell.z * height + height / 2);
        order_.clear();
        for (std::size_t p = 0; p < probes_.size(); ++p) {
            if (may_name(probes_[p]))
                order_.push_back(
                    {squared_distance(centre, probes_[p].position), static_cast<std::uint8_t>(p)});
        }
    }

    [[nodiscard]] bool may_name(const GridProbe& probe) const {
        const auto holds_cell = [&](const ClosedVolume* interior) {
            return std::ranges::all_of(
                all_points_, [&](const glm::vec3& point) { return interior->contains(glm::dvec3(point)); });
        };
        return probe.interiors.empty() || std::ranges::any_of(probe.interiors, holds_cell);
    }

    // The nearest that at least half of the points see, else the one that most see.
    std::optional<std::uint8_t> best_seen(const Hides& hides) {
        // Mostly the nearest is the one.
        std::ranges::iter_swap(order_.begin(), std::ranges::min_element(order_));
        const std::size_t half = (points_.size() + 1) / 2;
        std::optional<std::uint8_t> best;
        std::size_t most = 0;
        for (std::size_t n = 0; n < order_.size(); ++n) {
            if (n == 1)
                std::ranges::sort(order_.begin() + 1, order_.end());
            const std::uint8_t probe = order_[n].probe;
            const std::size_t seeing = points_that_see(probe, most, half, hides);
            if (seeing >= half)
                return probe;
            if (seeing > most) {
                most = seeing;
                best = probe;
            }
        }
        return best;
    }

    // No more than half, and not counted to the end when they cannot be more than `most`.
    std::size_t points_that_see(std::uint8_t probe,
                                std::size_t most,
                                std::size_t half,
                                const Hides& hides) const {
        std::size_t seeing = 0;
        for (std::size_t n = 0; n < points_.size() && seeing < half; ++n) {
            if (seeing + (points_.size() - n) <= most)
                break;
            seeing += hides(points_[n], places_[probe]) ? 0u : 1u;
        }
        return seeing;
    }

    const std::span<const GridProbe> probes_;
    const SceneQueries& queries_;
    ProbeGrid grid_;
    Position corner_{};              // of the sector, at the grid's bottom
    std::vector<glm::vec3> places_;  // of the probes
    std::optional<Spaces> spaces_;
    // Of the cell at work.
    std::vector<glm::vec3> all_points_;
    std::vector<glm::vec3> points_;
    std::vector<Near> order_;
};

}  // namespace

ProbeGrid build_grid(std::int32_t i,
                     std::int32_t j,
                     std::span<const GridProbe> probes,
                     const SceneQueries& queries) {
    assert(probes.size() <= max_probes);
    return GridBuild(i, j, probes, queries).run();
}

}  // namespace drtv::placement
