// The colour of a probe in a picture.
#pragma once

#include <drtv/sector.h>

#include <cstddef>

namespace drtv::tool {

// What colours the probes. The last two go from green to red, grey where the file has no quality: the largest
// of a probe's errors (PartQuality::seen_error), and the share of its paths that met the back of a one-sided
// surface, which tells holes in a map and walls that face the wrong way.
enum class DotQuantity { relit, sky, errors, back_hits };

// Linear. `sky_visibility`: the average of the three upward directions. REQUIRES: p < sector.probes.size().
[[nodiscard]] Float3 dot_colour(const Sector& sector,
                                std::size_t p,
                                float sky_visibility,
                                DotQuantity quantity);

}  // namespace drtv::tool
