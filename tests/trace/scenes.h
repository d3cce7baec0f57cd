// Maps for tracing, written as glTF and read back, in world axes (z up).
#pragma once

#include "bakerd/trace/scene.h"
#include "tests/map/gltf_builder.h"

#include <glm/mat4x4.hpp>

#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace drtv::test {

struct Thing {
    Shape shape;  // world axes before `world_from_shape`
    glm::dmat4 world_from_shape{1};
    MaterialSource material = {};
    std::string role = "static";
};

// Front upwards, around the origin.
[[nodiscard]] Shape level_square(float half_size_m, float z_m = 0);

// Four texels in a square of white; alpha 0 at the left, 255 at the right.
[[nodiscard]] Picture half_masked();

[[nodiscard]] std::shared_ptr<const map::Map> map_of(std::span<const Thing> things);

inline constexpr trace::WorldRectangle everywhere{glm::vec2(-8192), glm::vec2(8192)};

// A scene that holds on to what it needs.
[[nodiscard]] std::shared_ptr<const trace::Scene> scene_of(std::shared_ptr<const map::Map> map,
                                                           const trace::WorldRectangle& region = everywhere,
                                                           float reach_m = 0);
[[nodiscard]] inline std::shared_ptr<const trace::Scene> scene_of(std::span<const Thing> things) {
    return scene_of(map_of(things));
}

[[nodiscard]] Thing thing_of(const Shape& shape, const glm::vec3& colour = glm::vec3(1),
                             const std::string& role = "static");
[[nodiscard]] glm::vec3 random_direction(std::mt19937& random);
[[nodiscard]] float between(std::mt19937& random, float low, float high);
[[nodiscard]] Shape triangle_soup(std::mt19937& random, int count, float size_m);
// Turned, scaled unevenly and, when asked, mirrored.
[[nodiscard]] glm::dmat4 random_placement(std::mt19937& random, float spread_m, bool mirrored);

}  // namespace drtv::test
