// What changed between two sectors of one place: probes by their position, light in numbers.
#pragma once

#include "local_pairs.h"

#include <drtv/sector.h>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drtv::tool {

// Differences of one quantity over all its numbers, decoded.
struct QuantityChange {
    double largest = 0;
    double squares = 0;
    std::size_t count = 0;
    std::string at;  // where the largest is: "probe[3].transfer.g[2][0]", by the second sector's index

    void add(double difference, const std::string& where);
    void merge(const QuantityChange& other, const std::string& prefix);
    [[nodiscard]] double rms() const;
};

enum Quantity : std::size_t {
    transfer,
    sky_visibility,
    static_irradiance,
    light_groups,
    local_transfer,
    relit,
    quantity_count
};
inline constexpr std::array<std::string_view, quantity_count> quantity_names = {
    "transfer", "sky_visibility", "static_irradiance", "light_groups", "local_transfer", "relit"};

struct SectorDiff {
    // For each probe of the second sector: the first's at the same place, or no_match; its largest relit
    // change, 0 where it has no match.
    std::vector<std::size_t> match;
    std::vector<double> relit;
    std::vector<std::size_t> removed;  // probes of the first sector that have no match
    std::size_t added = 0;             // probes without a match
    std::size_t changed = 0;           // probes with other numbers than their match
    std::size_t cells = 0;             // of the grid, that name another probe
    // Of local transfer; those of added and removed probes too.
    std::size_t pairs_added = 0;
    std::size_t pairs_removed = 0;
    // Whether these differ.
    bool settings = false;
    bool statistics = false;
    bool convergence = false;
    bool interiors = false;
    bool quality = false;
    // Light groups that only one of the two has, by name.
    std::vector<std::string> groups_only_first;
    std::vector<std::string> groups_only_second;
    bool grid_place = false;
    std::array<QuantityChange, quantity_count> changes;

    [[nodiscard]] bool equal() const;
};

// REQUIRES: both are of one place. A section that only one has counts as zeros in the other.
[[nodiscard]] SectorDiff diff_sectors(const Sector& first, const Sector& second);

}  // namespace drtv::tool
