#include "tests/picture/yard.h"

#include "tests/ambient/talk_scene.h"
#include "tests/bake/worlds.h"

#include <drtv/day.h>

#include <stdexcept>

namespace drtv::test {
namespace {

constexpr double hours = 10;

}  // namespace

GltfBuilder yard() {
    SceneSource scene = talk_scene();
    GltfBuilder& b = scene.b;
    const int lantern = b.add_light({{"type", "point"}, {"color", {1, 0.7, 0.4}}, {"intensity", 4000}});
    b.add_node({.light = lantern, .translation = {{26, 4, -20}}, .light_group = "lanterns"});
    const int lamp = b.add_light({{"type", "point"}, {"intensity", 1500}});
    b.add_node({.light = lamp, .translation = {{60, 3, -30}}});
    Json glowing = {{"emissiveFactor", {1, 0.5, 0.2}},
                    {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 3000}}}}}};
    b.json["materials"].push_back(glowing);
    const int material = static_cast<int>(b.json["materials"].size()) - 1;
    b.add_node({.mesh = b.add_mesh(in_gltf(box({70, 20, 0}, {71, 21, 1})), material),
                .name = "glowing",
                .light_group = "lanterns"});
    const int leaf = b.add_material({.colour = {0.1f, 0.3f, 0.05f, 1}, .double_sided = true, .name = "leaf"});
    Shape leaves;
    leaves.positions = {{20, 10, 3}, {24, 10, 3}, {24, 14, 3.5f}, {20, 14, 3.5f}};
    leaves.indices = {0, 1, 2, 0, 2, 3};
    b.add_node({.mesh = b.add_mesh(in_gltf(leaves), leaf), .name = "leaves", .role = "vegetation"});
    return b;
}

const BakedMap& baked_yard() {
    static const BakedMap map = baked_like_talk_scene(yard());
    return map;
}

std::unique_ptr<const picture::Scenery> scenery_of(const GltfBuilder& builder) {
    auto map = builder.import();
    if (!map)
        throw std::runtime_error(map.error());
    auto scenery = picture::Scenery::build(std::make_shared<const map::Map>(std::move(*map)), glm::vec2(0));
    if (!scenery)
        throw std::runtime_error(scenery.error().sentence);
    return std::move(*scenery);
}

const picture::Scenery& yard_scenery() {
    static const std::unique_ptr<const picture::Scenery> scenery = scenery_of(yard());
    return *scenery;
}

std::unique_ptr<kit::RequestedLight> morning() {
    auto light = std::make_unique<kit::RequestedLight>();
    light->light = light_of_day(light->day.day(), hours, RelightMode::accurate, {});
    light->light.other_groups = {1, 1, 1};
    light->lamps.push_back({{30, 26, 2.5}, {40, 30, 20}});
    return light;
}

}  // namespace drtv::test
