// A region of sectors from above: probes as dots over a shaded map of sky visibility, in a frame.
#pragma once

#include "dot_colour.h"
#include "image/map_sheet.h"
#include "image/underlay.h"

#include <drtv/sector.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
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

struct RegionPicture {
    std::vector<std::array<std::int32_t, 2>> sectors;
    std::vector<Dot> dots;
    std::string title;
    std::vector<ColourMeaning> legend;

    // All probes of a sector.
    void add(const Sector& sector, const DotColour& colour);

    // Divides colours so that of those that are not black all but the brightest fiftieth are at most white,
    // and says so in the legend.
    void scale_colours();
};

struct DrawnRegion {
    image::MapSheet sheet;
    std::string note;  // one sentence, where the scale is not the one that was asked for
};

// Where there is a picture to lie under, the ground is that. `metres_per_pixel` as image::measure has it.
// REQUIRES: at least one sector.
[[nodiscard]] DrawnRegion draw(const RegionPicture& picture,
                               double metres_per_pixel,
                               const image::Underlay* under = nullptr);

}  // namespace drtv::tool
