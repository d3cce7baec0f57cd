// How much light changes from one sector to the next, beside how much it changes inside the two (SPEC.md,
// section 6).
#pragma once

#include <drtv/validate_region.h>

#include <array>
#include <cstddef>

namespace drtv {

// E/pi under a white sky of radiance 1, [b][c].
[[nodiscard]] std::array<float, basis_count * channel_count> light_under_white_sky(const Probe& probe);

struct BorderStep {
    double across = 0;  // mean step between the probes of the cells on both sides, less what is explained
    double inside =
        0;  // mean step between cells side by side that name different probes; 0 where there are none
    std::size_t steps_inside = 0;
};

// From `west` to `east` (axis 0), or from the south to the north (axis 1).
[[nodiscard]] BorderStep border_step(const RegionSector& west, const RegionSector& east, std::size_t axis);

}  // namespace drtv
