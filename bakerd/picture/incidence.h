#pragma once

#include <glm/vec3.hpp>

#include <optional>

namespace drtv::picture {

// A light that shines on a surface.
struct Incidence {
    glm::vec3 direction{};           // towards it, unit
    glm::vec3 irradiance{};          // of a surface that faces it
    std::optional<glm::vec3> place;  // none of the sun
};

}  // namespace drtv::picture
