// What colours the probes of a picture.
#pragma once

#include "cli/failure.h"
#include "kit/light_request.h"

#include <drtv/sector.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace drtv::tool {

// The linear colour of a probe: asked with its index and its sky visibility, the average of the three upward
// directions. REQUIRES: the index is below the number of the sector's probes.
using DotColour = std::function<Float3(const Sector&, std::size_t, float)>;

struct ColourMeaning {
    Float3 colour;  // linear
    std::string text;
};

struct DotQuantity {
    std::string name;   // as --quantity has it
    std::string words;  // of what the picture is one
    DotColour colour;
    std::vector<ColourMeaning> legend;
    // Whether colours are quantities of any size, to be divided so that nearly the brightest is white.
    bool is_scaled = false;
    bool needs_quality = false;  // files without quality have probes of unknown_colour
};

inline constexpr Float3 unknown_colour = {0.2f, 0.2f, 0.2f};

// Green at 0, yellow half way, red from 1 on.
[[nodiscard]] Float3 traffic_light(float share);

[[nodiscard]] std::vector<std::string> dot_quantity_names();

// `light` is that of "relit" alone; without a time it is a clear noon. Fails where the light cannot be read,
// or goes with another quantity. REQUIRES: the name is one of the above.
[[nodiscard]] cli::Result<DotQuantity> dot_quantity(const std::string& name, const kit::LightRequest& light);

}  // namespace drtv::tool
