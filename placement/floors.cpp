#include "placement/floors.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>

namespace drtv::placement {
namespace {

// Surfaces closer together than this are one (a column through a shared edge meets both triangles).
constexpr float same_surface_m = 1e-3f;

// Surfaces of a column at one height. A sheet is what is of no body (ColumnHit::body).
struct Level {
    float low_m = 0;
    std::optional<float> floor_m;  // the lowest that faces up
    bool floor_is_sheet = false;
    bool ceiling = false;  // one of them faces down
    bool sheet = false;
    bool sheet_ceiling = false;
};

// From the bottom up, whatever the order of what lies at one height.
std::vector<Level> levels_of(std::span<const ColumnHit> hits) {
    std::vector<Level> levels;
    for (std::size_t n = hits.size(); n-- > 0;) {
        const ColumnHit& hit = hits[n];
        if (levels.empty() || hit.z_m - levels.back().low_m >= same_surface_m)
            levels.emplace_back().low_m = hit.z_m;
        Level& level = levels.back();
        if (hit.up_facing && !level.floor_m)
            level.floor_m = hit.z_m;
        level.floor_is_sheet = level.floor_is_sheet || (hit.up_facing && !hit.body);
        level.ceiling = level.ceiling || hit.down_facing;
        level.sheet = level.sheet || !hit.body;
        level.sheet_ceiling = level.sheet_ceiling || (hit.down_facing && !hit.body);
    }
    return levels;
}

// Up to the level above; none when that one is left through its back, because then the space between is the
// inside of something. Past the bodies that hang over a sheet the next sheet tells: what is sunk into the
// ground has its bottom there, and the sea goes on below.
float free_height(const std::vector<Level>& levels, std::size_t floor) {
    if (floor + 1 == levels.size())
        return std::numeric_limits<float>::infinity();
    const Level& above = levels[floor + 1];
    if (!above.ceiling)
        return 0;
    if (levels[floor].floor_is_sheet) {
        const auto sheet = std::find_if(levels.begin() + static_cast<std::ptrdiff_t>(floor) + 1,
                                        levels.end(),
                                        [](const Level& level) { return level.sheet; });
        if (sheet != levels.end() && !sheet->sheet_ceiling)
            return 0;
    }
    return above.low_m - *levels[floor].floor_m;
}

}  // namespace

std::vector<Floor> floors_of(std::span<const ColumnHit> hits) {
    const std::vector<Level> levels = levels_of(hits);
    std::vector<Floor> floors;
    for (std::size_t n = 0; n < levels.size(); ++n) {
        if (levels[n].floor_m)
            floors.push_back({*levels[n].floor_m, free_height(levels, n)});
    }
    return floors;
}

}  // namespace drtv::placement
