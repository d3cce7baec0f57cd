// How much static light one path can bring at most: from each of its bounces, the radiance of the map's
// brightest surface where its lights are brightest. It is what a path's weight is worth, where a change lets
// the path find something else. Assumes that one sampled light never contributes more than all lights
// together would.
#pragma once

#include "bakerd/bake/lights.h"
#include "bakerd/map/map.h"
#include "bakerd/trace/scene.h"
#include "placement/placement.h"
#include "settings/bake_settings.h"

#include <span>

namespace drtv::reuse {

// Of all lights within reach of the probes, over bake::static_irradiance_range; lamps shine on the surfaces
// of the scene, the nearest of each counts. 0 without lights. `scattered` is trace::max_scattered.
[[nodiscard]] float static_gain(const bake::StaticLights& lights,
                                float scattered,
                                const trace::Scene& scene,
                                std::span<const placement::Position> probes,
                                const settings::BakeSettings& settings);

// The same of surfaces anywhere in the boxes, and of lamps alone.
[[nodiscard]] float static_gain(const bake::StaticLights& lights,
                                float scattered,
                                std::span<const map::Bounds> boxes,
                                const settings::BakeSettings& settings);

// A gain that was found for surfaces of `scattered_before`, where there are brighter ones now.
[[nodiscard]] float raised_gain(float gain,
                                float scattered_before,
                                float scattered_now,
                                const settings::BakeSettings& settings);

}  // namespace drtv::reuse
