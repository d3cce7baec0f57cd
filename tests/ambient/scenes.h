// Maps on which the whole way is tried, in world axes (z up).
#pragma once

#include "tests/map/gltf_builder.h"

#include <glm/vec3.hpp>

#include <optional>
#include <string>

namespace drtv::test {

[[nodiscard]] bool is_between(const glm::vec3& place, const glm::vec3& low, const glm::vec3& high);

struct SceneSource {
    GltfBuilder b;

    void add(const Shape& in_world, const glm::vec3& albedo, const std::string& role = "");
    void add_box(const glm::vec3& low, const glm::vec3& high, const glm::vec3& albedo);
    // Inside of it, the probe at `probe` lights alone.
    void add_interior(const glm::vec3& low, const glm::vec3& high, const glm::vec3& probe);
    void add_probe(const glm::vec3& at);
};

// An endless grey plane, but for its end at 400 m.
[[nodiscard]] SceneSource plane_scene(const glm::vec3& albedo);

// A house of two rooms, 3 m high, on grey ground, all of its walls and its roof 0.2 m thick: the western room
// has a window of 1.6 m to the south, the eastern one is closed. The wall between them stands at x = 32.
struct TwoRoomsSettings {
    glm::vec3 shift_m{0};
    float side_m = 7;  // of each room, along x; along y they have 7 m
    // How far the rooms' interiors reach beyond their inner surfaces; without, there are none.
    std::optional<float> interiors_reach_m = {};
};
struct TwoRooms {
    SceneSource source;
    glm::vec3 west_low{}, west_high{};
    glm::vec3 east_low{}, east_high{};
    glm::vec3 outer_low{}, outer_high{};
};
[[nodiscard]] TwoRooms two_rooms(const TwoRoomsSettings& settings);

}  // namespace drtv::test
