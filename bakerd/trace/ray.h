#pragma once

#include <glm/vec3.hpp>

namespace drtv::trace {

struct Ray {
    glm::vec3 origin;
    glm::vec3 direction;  // unit
    float far_m = 0;      // hits at this distance or less count
};

}  // namespace drtv::trace
