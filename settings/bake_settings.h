// What can be asked of a bake and of the job that asks for it. Names, ranges and defaults: settings/table.h.
#pragma once

#include <cstdint>

namespace drtv::settings {

// All that changes the bytes of a sector file, besides the map. The defaults are those of the preset
// "console".
struct BakeSettings {
    std::uint32_t rays = 2048;  // primary rays per probe
    std::uint32_t bounces = 3;  // surface bounces
    float reach_m = 512;        // farther than this from the probe is sky
    float min_distance_m = 6;   // between automatic probes
    float error = 0;            // standard error at which a probe stops early, 0: none (bake/convergence.h)
    bool local_transfer = false;
    std::uint32_t local_bounces = 2;  // surface bounces of local transfer
    std::uint32_t local_rays = 1024;  // traced from each source of local transfer

    bool operator==(const BakeSettings&) const = default;
};

struct JobSettings {
    BakeSettings bake;
    // How far an older result that stands in for a new one may be off, as a share of a coefficient's range
    // (reuse/assessment.h); 0: not at all.
    float tolerance = 1 / 512.0f;

    bool operator==(const JobSettings&) const = default;
};

}  // namespace drtv::settings
