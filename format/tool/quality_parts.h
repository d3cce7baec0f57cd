// What a file's quality says of the parts of a probe's light, beside how much of it there is.
#pragma once

#include <drtv/sector.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace drtv::tool {

struct PartQuality {
    std::string name;  // "transfer", "sky visibility", "static light", "group 'lanterns'"
    float error = 0;   // over the part's own mean
    float mean = 0;    // E/pi under a sky of radiance 1, or W/m2
    float faint = 0;   // a mean below this is hardly seen

    // Counts less where there is hardly any light: what is nearly dark may be far off.
    [[nodiscard]] float seen_error() const { return error * std::min(1.0f, mean / faint); }
};

// Of a probe, in one order for all probes of the sector. REQUIRES: the sector has quality, p <
// sector.probes.size().
[[nodiscard]] std::vector<PartQuality> quality_parts(const Sector& sector, std::size_t p);

}  // namespace drtv::tool
