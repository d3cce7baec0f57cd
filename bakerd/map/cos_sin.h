#pragma once

#include <glm/vec2.hpp>

namespace drtv::map {

// Cosine and sine, within 2e-16 up to some thousand turns. The C library's own differ in their last bit
// between its versions and the instructions that it finds.
[[nodiscard]] glm::dvec2 cos_sin(double radians);

// Cosine and sine, as x and y, of an angle that is so many quarters of a turn more.
template <class Vec2>
[[nodiscard]] Vec2 quarters_on(const Vec2& cos_sin, int quarters) {
    const auto c = cos_sin.x;
    const auto s = cos_sin.y;
    switch (quarters & 3) {
        case 0:
            return {c, s};
        case 1:
            return {-s, c};
        case 2:
            return {-c, -s};
        default:
            return {s, -c};
    }
}

}  // namespace drtv::map
