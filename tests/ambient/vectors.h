// GLM's vectors and the runtime's.
#pragma once

#include <drtv/conventions.h>

#include <glm/vec3.hpp>

namespace drtv::test {

[[nodiscard]] inline glm::dvec3 as_double(const Float3& v) {
    return {v[0], v[1], v[2]};
}
[[nodiscard]] inline Float3 as_float(const glm::dvec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
[[nodiscard]] inline Double3 as_place(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

}  // namespace drtv::test
