#pragma once

#include <glm/vec2.hpp>

namespace drtv::map {

// Cosine and sine, within 2e-16 up to some thousand turns. The C library's own differ in their last bit
// between its versions and the instructions that it finds.
[[nodiscard]] glm::dvec2 cos_sin(double radians);

}  // namespace drtv::map
