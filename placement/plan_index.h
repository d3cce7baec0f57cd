// Places by the square of the plan that they stand in, to look for near ones.
#pragma once

#include "placement/placement.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace drtv::placement {

class PlanIndex {
  public:
    void add(const Position& place, std::size_t number) { squares_[key_of(place, 0, 0)].push_back(number); }

    // Whether `test(number)` holds for any that stands so near in the plan; of some farther ones it is asked
    // as well.
    template <class Test>
    [[nodiscard]] bool any_near(const Position& place, float distance_m, Test test) const {
        const auto reach = static_cast<std::int32_t>(std::ceil(distance_m * units_per_m / side_units));
        for (std::int32_t dy = -reach; dy <= reach; ++dy) {
            for (std::int32_t dx = -reach; dx <= reach; ++dx) {
                const auto square = squares_.find(key_of(place, dx, dy));
                if (square == squares_.end())
                    continue;
                for (const std::size_t number : square->second) {
                    if (test(number))
                        return true;
                }
            }
        }
        return false;
    }

  private:
    static constexpr std::int32_t side_bits = 12;  // 4 m
    static constexpr float side_units = 1 << side_bits;

    [[nodiscard]] static std::uint64_t key_of(const Position& place, std::int32_t dx, std::int32_t dy) {
        const auto x = static_cast<std::uint32_t>((place.x >> side_bits) + dx);
        const auto y = static_cast<std::uint32_t>((place.y >> side_bits) + dy);
        return std::uint64_t{x} << 32 | y;
    }

    std::unordered_map<std::uint64_t, std::vector<std::size_t>> squares_;
};

}  // namespace drtv::placement
