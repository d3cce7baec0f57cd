#include "bakerd/map/cos_sin.h"

#include <cmath>

namespace drtv::map {

glm::dvec2 cos_sin(double radians) {
    // Whole quarters of a turn, and what is left: pi / 2 in three parts, of which multiples of the first two
    // are exact (Cody and Waite 1980).
    const double quarters = std::floor(radians * 0.63661977236758134308 + 0.5);
    const double x = ((radians - quarters * 0x1.921fb544p+0) - quarters * 0x1.0b4611a6p-34) -
                     quarters * 0x1.3198a2e037073p-69;
    // Taylor series, from the smallest term on; |x| is an eighth of a turn at most.
    const double square = x * x;
    double c = 0;
    double s = 0;
    for (int n = 20; n > 0; n -= 2) {
        c = (1 + c) * -square / (n * (n - 1));
        s = (1 + s) * -square / (n * (n + 1));
    }
    c = 1 + c;
    s = x + x * s;
    return quarters_on(glm::dvec2(c, s), static_cast<int>(std::fmod(quarters, 4.0)) + 4);
}

}  // namespace drtv::map
