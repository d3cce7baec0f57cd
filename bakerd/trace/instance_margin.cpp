#include "bakerd/trace/instance_margin.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace drtv::trace {

float instance_margin_m(const map::Map& map) {
    glm::vec3 farthest(1);
    for (const map::Object& object : map.objects) {
        farthest = glm::max(farthest, glm::max(glm::abs(object.bounds.low), glm::abs(object.bounds.high)));
        farthest = glm::max(farthest,
                            glm::abs(object.world_from_object[3]));  // a mesh may lie far from its own origin
    }
    for (const map::ProbeNode& probe : map.probes)
        farthest = glm::max(farthest, glm::vec3(glm::abs(probe.position)));
    const float extent_m = std::max({farthest.x, farthest.y, farthest.z});
    // With unit roundoff e = 2^-24 and rays between any two points of the map: 2 reciprocals off by 5 e and
    // the product of origin and reciprocal by e make 12 e of the extent; the transform into object space some
    // 20 e more. This is twice their sum.
    return static_cast<float>(std::bit_ceil(static_cast<std::uint32_t>(std::min(extent_m, 0x1p30f)))) *
           0x1p-18f;
}

std::optional<InstanceShape> instance_shape(const glm::mat4x3& world_from_object, float margin_m) {
    constexpr float largest_spread = 0x1p10f;
    constexpr float min_stretch = 0x1p-4f;
    glm::vec3 lengths{};
    glm::mat3 axes;
    for (glm::length_t k = 0; k < 3; ++k) {
        lengths[k] = glm::length(world_from_object[k]);
        if (!(lengths[k] > 0))
            return std::nullopt;
        axes[k] = world_from_object[k] / lengths[k];
    }
    // The squares of the factors by which the unit axes stretch lie around 1, no farther than these sums
    // (Gershgorin): 0 where the axes are orthogonal. A box whose corners are moved by the margin along each
    // axis grows by that times the least factor.
    const float xy = std::abs(glm::dot(axes[0], axes[1]));
    const float yz = std::abs(glm::dot(axes[1], axes[2]));
    const float zx = std::abs(glm::dot(axes[2], axes[0]));
    const float around = std::max({xy + zx, xy + yz, yz + zx});
    if (!(1 - around >= min_stretch))
        return std::nullopt;
    const float least = std::sqrt(1 - around);
    const float most = std::sqrt(1 + around);
    const float spread = most / least * std::max({lengths.x, lengths.y, lengths.z}) /
                         std::min({lengths.x, lengths.y, lengths.z});
    if (!(spread <= largest_spread))
        return std::nullopt;
    return InstanceShape{margin_m / least / lengths, spread};
}

}  // namespace drtv::trace
