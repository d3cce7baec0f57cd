// A region of sectors from above: probes as dots over a shaded map of sky visibility.
#pragma once

#include "kit/png.h"
#include "underlay.h"

#include <drtv/sector.h>

#include <cstddef>
#include <functional>
#include <vector>

namespace drtv::tool {

struct Dot {
    double x_m = 0;
    double y_m = 0;
    double z_m = 0;
    float sky_visibility = 0;  // average of the three upward directions
    ProbeKind kind = ProbeKind::ground;
    Float3 colour{};  // linear
};

// Of a probe: asked with its index and sky visibility.
using DotColour = std::function<Float3(std::size_t, float)>;

struct RegionPicture {
    std::vector<std::array<std::int32_t, 2>> sectors;
    std::vector<Dot> dots;

    // All probes of a sector.
    void add(const Sector& sector, const DotColour& colour);
};

// Where there is a picture to lie under, the ground is that. At 0 metres a pixel the longer side has about
// 1,600 pixels. Fails where the sectors lie too far apart for one picture. REQUIRES: at
// least one sector.
[[nodiscard]] cli::Result<kit::Image> draw(const RegionPicture& picture,
                                           double metres_per_pixel,
                                           const Underlay* under = nullptr);

}  // namespace drtv::tool
