// Embree 3.13 looks for the instances that a ray may meet without its robust test, whatever the scene's flags
// say: for a direction component of 0 it computes `lower * 1e18 - origin * 1e18`, which is off by the
// rounding of the origin, and with reciprocals that differ by CPU vendor. So the boxes of instances are made
// larger by more than all of that.
#pragma once

#include "bakerd/map/map.h"

#include <glm/common.hpp>
#include <glm/mat4x3.hpp>
#include <glm/vec3.hpp>

#include <optional>

namespace drtv::trace {

// How much larger the boxes must be in the world. A power of two, so that it stays the same where a map grows
// a little.
[[nodiscard]] float instance_margin_m(const map::Map& map);

struct InstanceShape {
    glm::vec3 margin{0};  // by which to enlarge a box in object space, along its axes, so that in the world
                          // it grows by a given margin
    float spread =
        1;  // the largest over the smallest factor by which the transform changes a length, at most

    void extend(const InstanceShape& other) {
        margin = glm::max(margin, other.margin);
        spread = glm::max(spread, other.spread);
    }
    // What is made for this shape is good for the other too.
    [[nodiscard]] bool covers(const InstanceShape& other) const {
        return margin == glm::max(margin, other.margin) && spread >= other.spread;
    }
};

// Nothing for a transform so flat or sheared that its inverse is mere rounding in single precision.
[[nodiscard]] std::optional<InstanceShape> instance_shape(const glm::mat4x3& world_from_object,
                                                          float margin_m);

}  // namespace drtv::trace
