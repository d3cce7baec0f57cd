// Whether a point stands inside a solid: rays in all directions that meet backs first say so.
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>

namespace drtv::placement {

// A point stands in a solid when more than a quarter of these rays meet a back. Unit vectors, up first. Not
// for use before main().
[[nodiscard]] std::span<const glm::vec3> solid_test_directions();
[[nodiscard]] bool is_in_solid(std::size_t backs);
// How many of the rays would have to end otherwise for the answer to change.
[[nodiscard]] std::size_t backs_to_flip(std::size_t backs);

}  // namespace drtv::placement
