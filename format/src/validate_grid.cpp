// Rules for the grid: a cell names one of the probes that are nearest to its centre (SPEC.md, section 5.5).
#include "sentence.h"
#include "validate_rules.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace drtv {
namespace {

constexpr std::size_t considered_probes = 4;
constexpr std::size_t cells_of_level = grid_size * grid_size;

// In units from the grid's corner; whole numbers, whose squared distances a double holds exactly as far as
// probes can lie apart.
struct Point {
    double x;
    double y;
    double z;
};

std::vector<Point> points_of(const Sector& sector) {
    const std::int64_t grid_bottom = sector.grid.z_origin_units;
    std::vector<Point> points;
    points.reserve(sector.probes.size());
    for (const Probe& probe : sector.probes) {
        const auto [x, y, z] = probe.position;
        const std::int64_t bottom = sector.z_origin_units - grid_bottom;
        const std::int64_t height = bottom + (std::int64_t{z} << sector.z_shift);
        Point& point = points.emplace_back();
        point.x = x;
        point.y = y;
        point.z = static_cast<double>(height);
    }
    return points;
}

// Whether fewer than `considered_probes` probes come before `named` by (distance, index).
bool is_among_nearest(const std::vector<double>& squared, std::size_t named) {
    const double its = squared[named];
    std::size_t before = 0;
    for (std::size_t p = 0; p < named; ++p)
        before += squared[p] <= its ? 1u : 0u;
    for (std::size_t p = named + 1; p < squared.size(); ++p)
        before += squared[p] < its ? 1u : 0u;
    return before < considered_probes;
}

// The middle of the n-th of cells of this size.
double middle_of(std::size_t n, double size) {
    return size * static_cast<double>(n) + size / 2;
}

// For each cell whether it names one of the probes nearest to its centre; false where it names none.
std::array<bool, grid_cell_count> cells_of_near_probes(const Sector& sector) {
    const std::vector<Point> points = points_of(sector);
    const std::size_t count = points.size();
    constexpr double width = sector_size_m * position_units_per_m / double{grid_size};
    const double height = sector.grid.cell_height_units;
    const double middle = std::floor(height / 2);
    std::array<bool, grid_cell_count> near{};
    std::vector<double> level(count);
    std::vector<double> squared(count);
    for (std::size_t column = 0; column < cells_of_level; ++column) {
        const double x = middle_of(column % grid_size, width);
        const double y = middle_of(column / grid_size, width);
        for (std::size_t p = 0; p < count; ++p) {
            const double dx = points[p].x - x;
            const double dy = points[p].y - y;
            level[p] = dx * dx + dy * dy;
        }
        for (std::size_t cz = 0; cz < grid_size; ++cz) {
            const std::size_t cell = column + cells_of_level * cz;
            const std::size_t named = sector.grid.cells[cell];
            if (named >= count)
                continue;
            const double z = height * static_cast<double>(cz) + middle;
            for (std::size_t p = 0; p < count; ++p) {
                const double dz = points[p].z - z;
                squared[p] = level[p] + dz * dz;
            }
            near[cell] = is_among_nearest(squared, named);
        }
    }
    return near;
}

}  // namespace

void check_grid(const SectionCheck& check) {
    const Sector& sector = check.sector;
    const std::size_t count = sector.probes.size();
    const std::array<bool, grid_cell_count> near = cells_of_near_probes(sector);
    for (std::size_t cell = 0; cell < grid_cell_count; ++cell) {
        const std::uint8_t named = sector.grid.cells[cell];
        const auto add = [&](const Issue& issue, const auto& message) {
            const std::uint64_t offset = check.place.at(layout::grid_header_bytes + cell);
            const auto path = [&] { return "grid.cells" + index(cell); };
            check.findings.add(issue, offset, named, path, message);
        };
        if (named == no_probe) {
            if (count > 0)
                add(issue::grid_no_probe, [&] { return sentence("names no probe, the sector has ", count); });
        } else if (named >= count) {
            add(issue::grid_reference,
                [&] { return sentence("names probe ", named, ", the sector has ", count); });
        } else if (!near[cell]) {
            add(issue::grid_not_nearest, [&] {
                return sentence("names probe ", named, ", and four others are nearer to its centre");
            });
        }
    }
}

}  // namespace drtv
