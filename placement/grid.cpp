#include "placement/grid.h"

#include <CGAL/Orthogonal_incremental_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <cassert>
#include <compare>
#include <utility>
#include <vector>

namespace drtv::placement {
namespace {

// Coordinates are whole numbers below 2^25, counted from the grid's corner, so that doubles hold squared
// distances exactly.
using Kernel = CGAL::Simple_cartesian<double>;
using IndexedPoint = std::pair<Kernel::Point_3, std::size_t>;
using Traits = CGAL::Search_traits_adapter<IndexedPoint,
                                           CGAL::First_of_pair_property_map<IndexedPoint>,
                                           CGAL::Search_traits_3<Kernel>>;
using Search = CGAL::Orthogonal_incremental_neighbor_search<Traits>;

constexpr std::int32_t margin_units = 2 * units_per_m;  // below the lowest and above the highest probe

struct Neighbour {
    double squared_distance;
    std::size_t probe;

    auto operator<=>(const Neighbour&) const = default;
};

// The `considered_probes` nearest by (distance, index).
void nearest_probes(const Search::Tree& tree, const Position& centre, std::vector<Neighbour>& nearest) {
    nearest.clear();
    const Search search(tree, Kernel::Point_3(centre.x, centre.y, centre.z));
    for (const auto& [point, squared] : search) {
        // The search leaves the order of equal distances open: take all of them before sorting.
        if (nearest.size() >= considered_probes && squared > nearest.back().squared_distance)
            break;
        nearest.push_back({squared, point.second});
    }
    std::sort(nearest.begin(), nearest.end());
    nearest.resize(std::min(nearest.size(), considered_probes));
}

// In units, as places are, which count from the grid's corner.
struct CellSize {
    std::int32_t width;
    std::int32_t height;

    [[nodiscard]] Position centre(std::int32_t x, std::int32_t y, std::int32_t z) const {
        return {x * width + width / 2, y * width + width / 2, z * height + height / 2};
    }
};

// Sets the vertical extent.
void span_probes(std::span<const Position> probes, ProbeGrid& grid) {
    const auto by_height = [](const Position& a, const Position& b) { return a.z < b.z; };
    const auto [lowest, highest] = std::minmax_element(probes.begin(), probes.end(), by_height);
    const std::int32_t bottom = lowest->z - margin_units;
    const std::int32_t top = highest->z + margin_units;
    const std::int32_t height = std::max(units_per_m, (top - bottom + 15) / 16);
    grid.z_origin_units = bottom;
    grid.cell_height_units = static_cast<std::uint32_t>(height);
}

}  // namespace

ProbeGrid build_grid(std::int32_t i,
                     std::int32_t j,
                     std::span<const Position> probes,
                     const Surroundings& surroundings) {
    assert(probes.size() <= max_probes);
    ProbeGrid grid;
    grid.cells.fill(no_probe);
    if (probes.empty())
        return grid;
    span_probes(probes, grid);

    constexpr std::int32_t side = sector_size_m * units_per_m;
    const Position corner(i * side, j * side, grid.z_origin_units);
    std::vector<IndexedPoint> points;
    for (std::size_t p = 0; p < probes.size(); ++p) {
        const Position local = probes[p] - corner;
        points.emplace_back(Kernel::Point_3(local.x, local.y, local.z), p);
    }
    Search::Tree tree(points.begin(), points.end());
    tree.build();

    std::vector<Neighbour> nearest;
    const auto probe_for = [&](const Position& centre) {
        nearest_probes(tree, centre, nearest);
        const glm::vec3 eye = metres(corner + centre);
        for (const Neighbour& near : nearest) {
            if (surroundings.sees(eye, metres(probes[near.probe])))
                return near.probe;
        }
        return nearest.front().probe;
    };
    constexpr auto cells_along = static_cast<std::int32_t>(grid_size);
    const CellSize size{side / cells_along, static_cast<std::int32_t>(grid.cell_height_units)};
    std::size_t cell = 0;
    for (std::int32_t z = 0; z < cells_along; ++z) {
        for (std::int32_t y = 0; y < cells_along; ++y) {
            for (std::int32_t x = 0; x < cells_along; ++x) {
                const std::size_t chosen = probe_for(size.centre(x, y, z));
                grid.cells[cell++] = static_cast<std::uint8_t>(chosen);
            }
        }
    }
    return grid;
}

}  // namespace drtv::placement
