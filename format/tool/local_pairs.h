// The pairs of local transfer that one probe has, so that two sectors can be held against each other.
#pragma once

#include <drtv/sector.h>

#include <array>
#include <compare>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace drtv::tool {

// For a probe that has no counterpart in the other sector.
inline constexpr std::size_t no_match = SIZE_MAX;

// The source of a pair: a probe of a neighbour by its number there, as the files say it; one of the own
// sector by its number in the second of the two, where it has one.
struct PairSource {
    int di;
    int dj;
    bool only_first;  // a probe of the first sector that the second has not: its number there
    std::size_t probe;

    auto operator<=>(const PairSource&) const = default;
};

using Coefficients = std::array<std::array<double, sh_count>, channel_count>;
using LocalPairs = std::map<PairSource, Coefficients>;

// All pairs of receiver p, decoded; none where the sector has no local transfer. `new_index`, where given:
// each own probe's number in the second sector, or no_match. REQUIRES: p < sector.probes.size().
[[nodiscard]] LocalPairs local_pairs_of(const Sector& sector,
                                        std::size_t p,
                                        const std::vector<std::size_t>* new_index = nullptr);

// "probe 3 of (1, 2)", seen from a receiver in `sector`.
[[nodiscard]] std::string text(const PairSource& source, const Sector& sector);

}  // namespace drtv::tool
