// The sky's direct light by its visibility.
#pragma once

#include <drtv/light.h>

#include <array>

namespace drtv {

// What a visibility of 1 brings, [c][b]. The talk's code takes the sky's radiance in the direction itself.
[[nodiscard]] std::array<Float4, channel_count> sky_direct(const SceneLight& light);

}  // namespace drtv
