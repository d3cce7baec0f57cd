// A view that shows a map well, where nobody says which.
#pragma once

#include "bakerd/trace/scene.h"

#include <drtv/sector_set.h>

#include <glm/vec3.hpp>

#include <optional>

namespace drtv::picture {

struct View {
    glm::vec3 eye{};
    glm::vec3 look{};
};

// Eyes are 1.7 m over ground on which a probe stands; nothing is nearer than 2 m, at most 60 % is sky, and at
// least three objects are in sight. Of these the one that sees most objects, near and far, and about a third
// of sky; where none is so, the best of those that see anything. Nothing where no ground is in sight of any
// probe. A function of the scene and the set.
[[nodiscard]] std::optional<View> view_by_rule(const trace::Scene& scene, const SectorSet& set);

}  // namespace drtv::picture
