// Pictures as the bake looks at them: samples of colour and alpha, and bounds of them. Any uv is safe.
#pragma once

#include "bakerd/map/map.h"

// The rest of what is asked of a picture.
#include "bakerd/map/texture_alpha.h"
#include "bakerd/map/texture_decode.h"
#include "bakerd/map/texture_filter.h"

#include <cstdint>

namespace drtv::map {

// The largest linear colour of any texel that is there at all.
[[nodiscard]] glm::vec3 brightest(const Texture& texture);

// The largest of any texel: no sample is brighter, of whatever level, but for the last digit.
[[nodiscard]] glm::vec3 brightest_of_all(const Texture& texture);

// Bilinear sample at uv of the mip level, at most the last one: the mean linear colour of what is there, as
// wide as one texel of that level. Level 0 is the picture itself.
[[nodiscard]] glm::vec3 sample_filtered(const Texture& texture, glm::vec2 uv, std::uint32_t level);

// The alpha of `sample`, without its colour.
[[nodiscard]] float sample_alpha(const Texture& texture, glm::vec2 uv);

// Bilinear sample of the red channel as it stands, in [0, 1]: of pictures that hold numbers, not colours.
[[nodiscard]] float sample_red(const Texture& texture, glm::vec2 uv);

// Bilinear sample at uv: linear colour, alpha in w.
[[nodiscard]] glm::vec4 sample(const Texture& texture, glm::vec2 uv);

}  // namespace drtv::map
