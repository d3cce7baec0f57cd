#include "placement/thinning.h"

#include "placement/plan_index.h"
#include "placement/units.h"

#include <algorithm>
#include <map>

namespace drtv::placement {
namespace {

class Thinner {
  public:
    Thinner(std::span<const Candidate> own, const Sees& sees) : own_(own), sees_(sees) {}

    // Those that have no earlier one nearer than the distance.
    std::vector<std::size_t> spaced(float growth, bool by_sight) {
        std::vector<std::size_t> kept;
        fill(growth, by_sight, own_.size(), kept);
        return kept;
    }

    // Adds those that no kept one takes the place of, up to so many in all.
    void fill(float growth, bool by_sight, std::size_t max_count, std::vector<std::size_t>& kept) {
        PlanIndex index;
        for (const std::size_t n : kept)
            index.add(own_[n].position, n);
        for (std::size_t n = 0; n < own_.size() && kept.size() < max_count; ++n) {
            const auto takes_its_place = [&](std::size_t other) {
                return n == other || (are_near(n, other, growth) && (!by_sight || see(n, other)));
            };
            if (index.any_near(own_[n].position, own_[n].min_distance_m * growth, takes_its_place))
                continue;
            index.add(own_[n].position, n);
            kept.push_back(n);
        }
    }

  private:
    [[nodiscard]] bool are_near(std::size_t a, std::size_t b, float growth) const {
        const float distance_m = std::min(own_[a].min_distance_m, own_[b].min_distance_m);
        return squared_distance(own_[a].position, own_[b].position) < squared_units(distance_m * growth);
    }

    [[nodiscard]] bool see(std::size_t a, std::size_t b) {
        const auto [known, added] = seen_.try_emplace({a, b}, false);
        if (added)
            known->second = sees_(own_[a].position, own_[b].position);
        return known->second;
    }

    const std::span<const Candidate> own_;
    const Sees& sees_;
    std::map<std::pair<std::size_t, std::size_t>, bool> seen_;
};

}  // namespace

Thinned thin(std::span<const Candidate> own, std::size_t max_count, const Sees& sees) {
    constexpr float step = 1.125f;
    constexpr float max_growth = 16;  // then what hides from each other is too much for a file
    Thinned thinned;
    if (max_count == 0)
        return thinned;
    Thinner thinner(own, sees);
    bool by_sight = true;
    std::vector<std::size_t> kept = thinner.spaced(1, by_sight);
    const bool too_many = kept.size() > max_count;
    float grown = 1;
    while (kept.size() > max_count) {
        thinned.growth = grown;
        grown *= step;
        if (by_sight && grown > max_growth) {
            by_sight = false;
            thinned.growth = grown = 1;
        }
        kept = thinner.spaced(grown, by_sight);
    }
    // The last step took too many.
    if (too_many)
        thinner.fill(thinned.growth, by_sight, max_count, kept);
    for (const std::size_t n : kept)
        thinned.probes.push_back({own[n].position, own[n].kind, own[n].moved});
    return thinned;
}

}  // namespace drtv::placement
