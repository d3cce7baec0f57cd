// Numbers that belong together. Here for inlining.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace drtv::placement {

// Sets that are joined two at a time, with halving of paths (Tarjan 1975).
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count = 0) : parents_(count) {
        std::iota(parents_.begin(), parents_.end(), 0u);
    }

    [[nodiscard]] std::uint32_t root_of(std::uint32_t n) {
        while (parents_[n] != n)
            n = parents_[n] = parents_[parents_[n]];
        return n;
    }
    // The smaller number stays the root.
    void join(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t root_a = root_of(a);
        const std::uint32_t root_b = root_of(b);
        parents_[std::max(root_a, root_b)] = std::min(root_a, root_b);
    }

  private:
    std::vector<std::uint32_t> parents_;
};

}  // namespace drtv::placement
