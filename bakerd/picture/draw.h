// Pictures from painters.
#pragma once

#include "bakerd/picture/painter.h"
#include "format/image/png.h"

#include <functional>
#include <optional>

namespace drtv::picture {

// Told how many steps are done; from any thread.
using Progress = std::function<void(std::size_t done)>;

// How many steps a picture takes: its rows, twice where it shows light and edges are smoothed.
[[nodiscard]] std::size_t draw_steps(Show show, Size size);

// One ray through the middle of each pixel; where the picture shows light, four more where a pixel differs
// from its neighbours. The same bytes for any number of threads. `exposure`: of light.
[[nodiscard]] image::Image draw(const Painter& painter, Size size, float exposure, const Progress& progress);

// Whether one of a grid of rays meets a surface.
[[nodiscard]] bool sees_anything(const Camera& camera, const trace::Scene& scene);

// By what to expose, over a grid of rays: where the whole scene is shown, the geometric mean of the luminance
// of surfaces over the root of their albedo, so that white maps come out brighter than dark ones, and not by
// all that they are; of a part of the light, its mean. The logarithm to the base of 2; nothing where no
// surface is lit.
[[nodiscard]] std::optional<double> brightness_log2(const Painter& painter,
                                                    const Camera& camera,
                                                    const trace::Scene& scene);

}  // namespace drtv::picture
