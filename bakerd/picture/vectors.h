// GLM's vectors and the runtime's.
#pragma once

#include <drtv/conventions.h>

#include <glm/vec3.hpp>

namespace drtv::picture {

[[nodiscard]] inline glm::vec3 as_vec(const Float3& v) {
    return {v[0], v[1], v[2]};
}
[[nodiscard]] inline Float3 as_float3(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}
[[nodiscard]] inline Double3 as_place(const glm::vec3& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

}  // namespace drtv::picture
