#include "placement/grid.h"

#include <CGAL/Orthogonal_incremental_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <cassert>
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

// The `considered_probes` nearest by (distance, index).
void nearest_probes(const Search::Tree& tree,
                    const Position& centre,
                    std::vector<std::pair<double, std::size_t>>& nearest) {
    nearest.clear();
    const Search search(tree, Kernel::Point_3(centre.x, centre.y, centre.z));
    for (const auto& [point, squared] : search) {
        // The search leaves the order of equal distances open: take all of them before sorting.
        if (nearest.size() >= considered_probes && squared > nearest.back().first)
            break;
        nearest.emplace_back(squared, point.second);
    }
    std::sort(nearest.begin(), nearest.end());
    nearest.resize(std::min(nearest.size(), considered_probes));
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

    const auto by_height = [](const Position& a, const Position& b) { return a.z < b.z; };
    const std::int32_t bottom = std::min_element(probes.begin(), probes.end(), by_height)->z - margin_units;
    const std::int32_t top = std::max_element(probes.begin(), probes.end(), by_height)->z + margin_units;
    grid.z_origin_units = bottom;
    grid.cell_height_units = static_cast<std::uint32_t>(std::max(units_per_m, (top - bottom + 15) / 16));

    std::vector<IndexedPoint> points;
    constexpr std::int32_t side = sector_size_m * units_per_m;
    const Position corner(i * side, j * side, bottom);
    for (std::size_t p = 0; p < probes.size(); ++p) {
        const Position local = probes[p] - corner;
        points.emplace_back(Kernel::Point_3(local.x, local.y, local.z), p);
    }
    Search::Tree tree(points.begin(), points.end());
    tree.build();

    constexpr std::int32_t width = side / static_cast<std::int32_t>(grid_size);
    const auto height = static_cast<std::int32_t>(grid.cell_height_units);
    std::vector<std::pair<double, std::size_t>> nearest;
    std::size_t cell = 0;
    for (std::int32_t z = 0; z < 16; ++z) {
        for (std::int32_t y = 0; y < 16; ++y) {
            for (std::int32_t x = 0; x < 16; ++x, ++cell) {
                const Position centre(x * width + width / 2, y * width + width / 2, z * height + height / 2);
                nearest_probes(tree, centre, nearest);
                std::size_t chosen = nearest.front().second;
                for (const auto& [distance, probe] : nearest) {
                    if (!surroundings.sees(metres(corner + centre), metres(probes[probe])))
                        continue;
                    chosen = probe;
                    break;
                }
                grid.cells[cell] = static_cast<std::uint8_t>(chosen);
            }
        }
    }
    return grid;
}

}  // namespace drtv::placement
