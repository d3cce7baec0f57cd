// The scene as placement sees it.
#pragma once

#include "bakerd/trace/scene.h"
#include "placement/placement.h"

namespace drtv::bake {

// Things are numbered as the map's objects. REQUIRES: the functions are used while the scene lives.
[[nodiscard]] placement::SceneQueries queries_of(const trace::Scene& scene, float reach_m);

}  // namespace drtv::bake
