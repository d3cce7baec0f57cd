#include "placement/solid_test.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace drtv::placement {
namespace {

constexpr std::size_t ring_count = 6;
constexpr std::size_t ring_size = 8;
constexpr std::size_t look_count = 1 + ring_count * ring_size;
constexpr std::size_t min_backs = 39;  // four in five

// Up, and then evenly over the upper half of the sphere: rings at equal steps of height, each turned against
// the one before by half of its step (5, 12 and 13 make a right angle). The upper rings first, because they
// escape where anything does.
std::array<Look, look_count> make_looks() {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr std::array<std::array<glm::vec2, ring_size>, 2> around = {
        {{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}},
         {{{12, 5}, {-12, -5}, {-5, 12}, {5, -12}, {5, 12}, {-5, -12}, {-12, 5}, {12, -5}}}}};
    std::array<Look, look_count> made;
    made[0] = {{0, 0, 1}, infinity};
    std::size_t n = 1;
    for (std::size_t ring = ring_count; ring-- > 0;) {
        const float z = (static_cast<float>(ring) + 0.5f) / ring_count;
        for (const glm::vec2& way : around[ring % 2])
            made[n++] = {glm::vec3(glm::normalize(way) * std::sqrt(1 - z * z), z), infinity};
    }
    return made;
}

const std::array<Look, look_count> test_looks = make_looks();

}  // namespace

std::span<const Look> solid_test_looks() {
    return test_looks;
}

StandsAt stands_by(const Met& met) {
    if (met.misses == 0 && met.backs >= min_backs)
        return {Stand::behind, met.behind.value_or(0), 1};
    const std::size_t more_backs = min_backs - std::min(met.backs, min_backs);
    const std::size_t to_flip = met.misses > 0 ? met.misses : more_backs;
    return {Stand::free, 0, static_cast<std::uint8_t>(to_flip)};
}

StandsAt stands_at(const Position& position, const SceneQueries& queries) {
    // One says that the point is free; some more, that it takes more than a change of one to bury it.
    constexpr std::size_t enough_misses = 6;
    const glm::vec3 point = metres(position);
    if (const auto closed = queries.closed_around(point))
        return {Stand::in_solid, *closed, UINT8_MAX};
    const StandsAt stands = stands_by(queries.first_met(point, solid_test_looks(), enough_misses));
    if (stands.stand != Stand::free)
        return stands;
    if (const auto wall = queries.wall_within(point, wall_clearance_m))
        return {Stand::in_wall, *wall, stands.to_flip};
    return stands;
}

}  // namespace drtv::placement
