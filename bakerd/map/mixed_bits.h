// A word whose bits all depend on all of another's: SplitMix64's finaliser (Steele, Lea, Flood 2014).
#pragma once

#include <cstdint>

namespace drtv::map {

[[nodiscard]] inline std::uint64_t mixed_bits(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

}  // namespace drtv::map
