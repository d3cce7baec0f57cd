// A map like the talk's test scene (GDC 2012; slides 7 to 12): green terrain, a red and a blue wall, white
// spheres; also a white wall in the open, a hut with a door, and a jungle's canopy.
#pragma once

#include "tests/ambient/baked_map.h"
#include "tests/ambient/scenes.h"

#include <glm/vec3.hpp>

namespace drtv::test {

inline constexpr float sphere_radius_m = 1;
inline constexpr glm::vec3 beside_red(16, 32, 2);  // middles of spheres
inline constexpr glm::vec3 beside_blue(36, 32, 2);
inline constexpr glm::vec3 hut_low(44, 8, 0);  // its inside
inline constexpr glm::vec3 hut_high(50, 14, 3);
inline constexpr float white_wall_x = 84;  // 1 m thick, along y
inline constexpr glm::vec3 under_leaves(156, 32, 0.5f);
inline constexpr glm::vec3 in_clearing(108, 56, 0.5f);

[[nodiscard]] SceneSource talk_scene();
// Sectors (0, 0) to (2, 0) of the scene, or of one made of it; with local transfer.
[[nodiscard]] BakedMap baked_like_talk_scene(const GltfBuilder& builder);

// Baked once for each process.
[[nodiscard]] const BakedMap& baked_talk_scene();

}  // namespace drtv::test
