#include "placement/solid_test.h"

#include <glm/geometric.hpp>

#include <array>
#include <cstdlib>

namespace drtv::placement {
namespace {

using Directions = std::array<glm::vec3, 26>;

// Of 26 test rays; more, and the probe is inside something.
constexpr std::size_t max_backs = 6;

// The 26 directions from a cube's centre to its faces, edges and corners; up first, so that a probe that must
// move goes up rather than sideways.
Directions make_test_directions() {
    Directions directions;
    std::size_t n = 0;
    const auto add = [&](int x, int y, int z) {
        if (x != 0 || y != 0 || z != 0)
            directions[n++] = glm::normalize(glm::vec3(x, y, z));
    };
    for (int z : {1, 0, -1}) {
        for (int nonzero = 0; nonzero <= 2; ++nonzero) {
            for (int y : {0, 1, -1}) {
                for (int x : {0, 1, -1}) {
                    if (std::abs(x) + std::abs(y) == nonzero)
                        add(x, y, z);
                }
            }
        }
    }
    return directions;
}

const Directions test_directions = make_test_directions();

}  // namespace

std::span<const glm::vec3> solid_test_directions() {
    return test_directions;
}

bool is_in_solid(std::size_t backs) {
    return backs > max_backs;
}

std::size_t backs_to_flip(std::size_t backs) {
    return is_in_solid(backs) ? backs - max_backs : max_backs + 1 - backs;
}

}  // namespace drtv::placement
