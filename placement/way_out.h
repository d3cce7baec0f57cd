// How a probe gets out of what it stands in.
#pragma once

#include "placement/placement.h"

#include <span>

namespace drtv::placement {

// On which it looks for a free place: up, then sideways and up, then sideways. Not down: under what it stands
// on there is no room for it. Unit vectors. Not for use before main().
[[nodiscard]] std::span<const glm::vec3> ways_out();

// Whether the straight way leaves what the start stands in, and enters nothing: it comes to no surface from
// the front, and passes a sheet only when that is what it stood behind or in.
[[nodiscard]] bool leads_out(const Position& from,
                             const Position& to,
                             Stand stand,
                             const SceneQueries& queries);

}  // namespace drtv::placement
