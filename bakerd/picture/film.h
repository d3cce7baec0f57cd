// From radiance to the bytes of a picture.
#pragma once

#include "format/image/png.h"

#include <glm/vec3.hpp>

#include <cstddef>

namespace drtv::picture {

// How much a radiance is raised: 2^EV. At EV 0 a radiance of 1 comes out nearly white.
[[nodiscard]] float exposure_of(float ev);

// Linear, 0 to 1, channel by channel: a curve that keeps dark parts and rolls off towards white (K.
// Narkowicz, "ACES Filmic Tone Mapping Curve", 2016: a fit of the Academy's). Below 0 counts as 0.
[[nodiscard]] glm::vec3 filmic(const glm::vec3& exposed);

// Writes a pixel of linear colour.
void put_pixel(image::Image& image, std::size_t x, std::size_t y, const glm::vec3& linear);

// The EV at which surfaces of this brightness (brightness_log2 in draw.h) come out well; in quarters, so that
// it can be said again on the command line.
[[nodiscard]] float ev_for(double brightness_log2);

// Logarithm to the base of 2, the same on every machine; the C library's own may differ in its last digit.
// REQUIRES: finite, above 0.
[[nodiscard]] double log2_of(double value);

}  // namespace drtv::picture
