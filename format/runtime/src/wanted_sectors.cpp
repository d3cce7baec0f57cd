#include <drtv/sector_set.h>

#include "columns.h"

#include <algorithm>
#include <cmath>

namespace drtv {

std::size_t wanted_sectors(const Double3& camera_m, double radius_m, std::span<SectorId> out) {
    const auto [x_m, y_m, z_m] = camera_m;
    if (!in_reach(x_m) || !in_reach(y_m) || !(radius_m >= 0) || out.empty())
        return 0;
    const double radius = std::min(radius_m, 4.0 * max_sector_coordinate * side_m);
    const SectorId centre = sector_of_columns(column_at(x_m, 0).index, column_at(y_m, 0).index);
    struct Place {
        double distance_squared;
        SectorId id;
    };
    const auto place_of = [&, x = x_m, y = y_m](SectorId id) {
        const double dx = x - std::clamp(x, id.i * side_m, (id.i + 1.0) * side_m);
        const double dy = y - std::clamp(y, id.j * side_m, (id.j + 1.0) * side_m);
        return Place{dx * dx + dy * dy, id};
    };
    const auto before = [](const Place& a, const Place& b) {
        if (a.distance_squared != b.distance_squared)
            return a.distance_squared < b.distance_squared;
        return a.id.j != b.id.j ? a.id.j < b.id.j : a.id.i < b.id.i;
    };
    std::size_t count = 0;
    // Sorted as they come; the last gives way where there is no room.
    const auto add = [&](SectorId id) {
        const bool exists =
            std::abs(id.i) <= max_sector_coordinate && std::abs(id.j) <= max_sector_coordinate;
        const Place place = place_of(id);
        if (!exists || place.distance_squared > radius * radius)
            return;
        if (count == out.size() && !before(place, place_of(out[count - 1])))
            return;
        std::size_t n = count < out.size() ? count++ : count - 1;
        for (; n > 0 && before(place, place_of(out[n - 1])); --n)
            out[n] = out[n - 1];
        out[n] = id;
    };
    // Rings of sectors around that of the camera, until a ring is out of reach, or behind all that was found.
    for (std::int32_t ring = 0; ring <= 2 * max_sector_coordinate + 4; ++ring) {
        const double least = std::max(ring - 1, 0) * side_m;
        const bool full = count == out.size();
        if (least > radius || (full && least * least > place_of(out[count - 1]).distance_squared))
            break;
        for (std::int32_t j = -ring; j <= ring; ++j) {
            const bool whole_row = j == -ring || j == ring;
            for (std::int32_t i = -ring; i <= ring; i += whole_row ? 1 : std::max(2 * ring, 1))
                add({centre.i + i, centre.j + j});
        }
    }
    return count;
}

}  // namespace drtv
