// A baked sector beside the reference, number by number.
#pragma once

#include "bakerd/map/map.h"
#include "tests/reference/check_figures.h"

#include <drtv/sector.h>

#include <cstdint>
#include <string>
#include <vector>

namespace drtv::reference {

struct CheckSettings {
    std::size_t probes = 32;       // spread over the sector's list
    std::uint64_t paths = 131072;  // a probe, at least; rounded up to whole strata
    std::uint64_t seed = 1;        // 1 to 2^40
    std::size_t local = 4;         // sources a probe, of its own sector; 0: none
    unsigned threads = 2;          // they do not change the numbers
};

struct Quantity {
    std::string name;                  // "v", "T Y0", ...
    std::vector<ProbeFigures> probes;  // of R: the sources
    bool even_noise = true;            // the product's noise is about the same share of each probe's mean
};

// Quantities that the sector does not hold are left out.
[[nodiscard]] std::vector<Quantity> compare(const map::Map& map, const Sector& sector,
                                            const CheckSettings& settings);

}  // namespace drtv::reference
