#include "placement/manual.h"

#include "placement/units.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace drtv::placement {

bool is_before(const Position& a, const Position& b) {
    return std::tie(a.y, a.x, a.z) < std::tie(b.y, b.x, b.z);
}

std::vector<Manual> manual_probes(std::span<const HandPlacedProbe> manual) {
    std::vector<Manual> probes;
    for (const HandPlacedProbe& probe : manual)
        probes.push_back({to_position(probe.position), probe.interiors});
    std::ranges::stable_sort(probes, is_before, &Manual::position);
    std::vector<Manual> once;
    for (Manual& probe : probes) {
        if (once.empty() || once.back().position != probe.position) {
            once.push_back(std::move(probe));
            continue;
        }
        std::vector<const ClosedVolume*>& interiors = once.back().interiors;
        if (interiors.empty() || probe.interiors.empty())
            interiors.clear();
        else
            interiors.insert(interiors.end(), probe.interiors.begin(), probe.interiors.end());
    }
    return once;
}

bool serves(const Manual& probe, const Position& position) {
    const glm::dvec3 point(metres(position));
    return probe.interiors.empty() || std::ranges::any_of(probe.interiors, [&](const ClosedVolume* interior) {
               return interior->contains(point);
           });
}

}  // namespace drtv::placement
