#include "placement/solid_test.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace drtv::placement {
namespace {

constexpr std::size_t looks = 25;
constexpr std::size_t least_backs = 23;  // nine in ten

// Up, and three rings at 60, 35 and 15 degrees over the horizon: a room's walls are met by the lowest, and a
// slope under a rock by few of them.
std::array<Look, looks> make_looks() {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::array<Look, looks> made;
    made[0] = {{0, 0, 1}, infinity};
    std::size_t n = 1;
    for (const float rise : {1.73f, 0.7f, 0.27f}) {
        for (const glm::vec2& way :
             {glm::vec2(1, 0), {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}})
            made[n++] = {glm::normalize(glm::vec3(way, rise * glm::length(way))), infinity};
    }
    return made;
}

const std::array<Look, looks> test_looks = make_looks();

}  // namespace

std::span<const Look> solid_test_looks() {
    return test_looks;
}

StandsAt stands_by(const Met& met) {
    if (met.misses == 0 && met.backs >= least_backs)
        return {Stand::behind, met.behind.value_or(0), 1};
    const std::size_t more_backs = least_backs - std::min(met.backs, least_backs);
    const std::size_t to_flip = met.misses > 0 ? met.misses : more_backs;
    return {Stand::free, 0, static_cast<std::uint8_t>(to_flip)};
}

StandsAt stands_at(const Position& position, const Surroundings& surroundings) {
    // One says that the point is free; some more, that it takes more than a change of one to bury it.
    constexpr std::size_t enough_misses = 6;
    const glm::vec3 point = metres(position);
    if (const auto closed = surroundings.closed_around(point))
        return {Stand::in_solid, *closed, UINT8_MAX};
    const StandsAt stands = stands_by(surroundings.first_met(point, solid_test_looks(), enough_misses));
    if (stands.stand != Stand::free)
        return stands;
    if (const auto wall = surroundings.wall_within(point, wall_clearance_m))
        return {Stand::in_wall, *wall, stands.to_flip};
    return stands;
}

}  // namespace drtv::placement
