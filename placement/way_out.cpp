#include "placement/way_out.h"

#include "placement/solid_test.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>

namespace drtv::placement {
namespace {

std::array<glm::vec3, 17> make_ways() {
    std::array<glm::vec3, 17> ways;
    ways[0] = {0, 0, 1};
    std::size_t n = 1;
    for (const float z : {1.0f, 0.0f}) {
        for (const glm::vec2& way :
             {glm::vec2(1, 0), {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}})
            ways[n++] = glm::normalize(glm::vec3(way, z));
    }
    return ways;
}

const std::array<glm::vec3, 17> ways = make_ways();

}  // namespace

std::span<const glm::vec3> ways_out() {
    return ways;
}

bool leads_out(const Position& from, const Position& to, Stand stand, const SceneQueries& queries) {
    const glm::vec3 start = metres(from);
    const glm::vec3 way = glm::normalize(metres(to) - start);
    // From a little before, so that a wall in which it stands is crossed.
    const glm::vec3 before = start - way * wall_clearance_m;
    return std::ranges::none_of(queries.sides(before, metres(to)), [&](const Side& side) {
        if (!side.sheet)
            return side.front;
        const bool own_wall = stand == Stand::in_wall && side.distance_m <= 2 * wall_clearance_m;
        const bool own_back = stand == Stand::behind && !side.front;
        return !own_wall && !own_back;
    });
}

}  // namespace drtv::placement
