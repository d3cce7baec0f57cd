#include "placement/thinning.h"

#include "placement/units.h"

#include <algorithm>

namespace drtv::placement {
namespace {

// Those that have no earlier one nearer than the distance.
std::vector<PlacedProbe> spaced(std::span<const Candidate> own, float distance_m) {
    const std::int64_t min_squared = squared_units(distance_m);
    std::vector<PlacedProbe> probes;
    for (const Candidate& candidate : own) {
        const auto is_near = [&](const PlacedProbe& other) {
            return squared_distance(candidate.position, other.position) < min_squared;
        };
        if (std::ranges::none_of(probes, is_near))
            probes.push_back({candidate.position, candidate.kind});
    }
    return probes;
}

}  // namespace

Thinned thin(std::span<const Candidate> own, float min_distance_m, std::size_t max_count) {
    Thinned thinned;
    thinned.used_distance_m = min_distance_m;
    if (max_count == 0)
        return thinned;
    thinned.probes = spaced(own, thinned.used_distance_m);
    while (thinned.probes.size() > max_count) {
        thinned.used_distance_m *= 1.125f;
        thinned.probes = spaced(own, thinned.used_distance_m);
    }
    return thinned;
}

}  // namespace drtv::placement
