#include "tests/ambient/scenes.h"

#include "tests/bake/worlds.h"

#include <glm/vector_relational.hpp>

namespace drtv::test {
namespace {

constexpr glm::vec3 grey(0.5f);
constexpr float wall_m = 0.2f;

}  // namespace

bool is_between(const glm::vec3& place, const glm::vec3& low, const glm::vec3& high) {
    return glm::all(glm::greaterThan(place, low)) && glm::all(glm::lessThan(place, high));
}

void SceneSource::add(const Shape& in_world, const glm::vec3& albedo, const std::string& role) {
    b.place(in_gltf(in_world), role, b.add_material({.colour = {albedo, 1}}));
}

void SceneSource::add_box(const glm::vec3& low, const glm::vec3& high, const glm::vec3& albedo) {
    add(box(low, high), albedo);
}

void SceneSource::add_interior(const glm::vec3& low, const glm::vec3& high, const glm::vec3& probe) {
    const std::string name = "room " + std::to_string(b.json["nodes"].size());
    b.add_node({.mesh = b.add_mesh(in_gltf(box(low, high))),
                .name = name,
                .role = "interior",
                .probe = name + "'s probe"});
    b.add_node(
        {.translation = glm::dvec3(gltf_from_world(probe)), .name = name + "'s probe", .role = "probe"});
}

void SceneSource::add_probe(const glm::vec3& at) {
    b.add_node({.translation = glm::dvec3(gltf_from_world(at)), .role = "probe"});
}

SceneSource plane_scene(const glm::vec3& albedo) {
    SceneSource scene;
    scene.b.place(ground(400), "", scene.b.add_material({.colour = {albedo, 1}}));
    return scene;
}

TwoRooms two_rooms(const TwoRoomsSettings& settings) {
    TwoRooms rooms;
    rooms.source = plane_scene(grey);
    const float side = settings.side_m;
    constexpr float depth = 7;
    constexpr float height = 3;
    const glm::vec3 wall_low = glm::vec3(32, 24, 0) + settings.shift_m;  // of the wall between
    rooms.west_low = wall_low + glm::vec3(-side, 0, 0);
    rooms.west_high = wall_low + glm::vec3(0, depth, height);
    rooms.east_low = wall_low + glm::vec3(wall_m, 0, 0);
    rooms.east_high = rooms.east_low + glm::vec3(side, depth, height);
    const glm::vec3 low = rooms.west_low - glm::vec3(wall_m, wall_m, 0);
    const glm::vec3 high = rooms.east_high + glm::vec3(wall_m);
    rooms.outer_low = low;
    rooms.outer_high = high;
    SceneSource& s = rooms.source;
    s.add_box({low.x, low.y, high.z - wall_m}, high, grey);                                           // roof
    s.add_box({low.x, high.y - wall_m, 0}, {high.x, high.y, high.z - wall_m}, grey);                  // north
    s.add_box({low.x, low.y + wall_m, 0}, {low.x + wall_m, high.y - wall_m, high.z - wall_m}, grey);  // west
    s.add_box({high.x - wall_m, low.y + wall_m, 0}, {high.x, high.y - wall_m, high.z - wall_m}, grey);
    s.add_box({wall_low.x, low.y + wall_m, 0}, {rooms.east_low.x, high.y - wall_m, high.z - wall_m}, grey);
    // South, with the window in the western room's.
    const float left = rooms.west_low.x + side * 0.3f;
    const float right = left + side * 0.4f;
    constexpr float sill = 0.8f;
    const float lintel = sill + 1.6f;
    const float top = high.z - wall_m;
    const float inner = low.y + wall_m;
    s.add_box({low.x, low.y, 0}, {left, inner, top}, grey);
    s.add_box({right, low.y, 0}, {high.x, inner, top}, grey);
    s.add_box({left, low.y, 0}, {right, inner, sill}, grey);
    s.add_box({left, low.y, lintel}, {right, inner, top}, grey);
    if (settings.interiors_reach_m) {
        for (const auto& [room_low, room_high] :
             {std::pair(rooms.west_low, rooms.west_high), {rooms.east_low, rooms.east_high}}) {
            const float reach = *settings.interiors_reach_m;
            s.add_interior(room_low - reach, room_high + reach, (room_low + room_high) * 0.5f);
        }
    }
    return rooms;
}

}  // namespace drtv::test
