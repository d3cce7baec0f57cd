#include "tests/bake/worlds.h"

#include "bakerd/bake/sector_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace drtv::test {

GltfBuilder clutter(const Clutter& size) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(size.low_m, size.high_m), height(2, 9);
    GltfBuilder b;
    const auto at_random = [&](double height_m) {
        const float east_m = place(random), north_m = place(random);
        return glm::dvec3(east_m, height_m, -north_m);
    };
    const int grass = b.add_material({.colour = {0.2f, 0.4f, 0.1f, 1}});
    const int stone = b.add_material({.colour = {0.5f, 0.45f, 0.4f, 1}});
    const int leaf = b.add_material({.colour = {0.1f, 0.3f, 0.05f, 1}});
    b.add_node({.mesh = b.add_mesh(ground(size.ground_m), grass)});
    const int block = b.add_mesh(box({-2, 0, -2}, {2, 5, 2}), stone);
    const int crown = b.add_mesh(box({-1.5f, 2, -1.5f}, {1.5f, 6, 1.5f}), leaf);
    for (int n = 0; n < size.blocks; ++n) {
        b.add_node({.mesh = block, .translation = at_random(-1), .rotation = glm::dvec4(0, 0.28, 0, 0.96)});
    }
    for (int n = 0; n < size.crowns; ++n) {
        const glm::dvec3 scale(1, height(random) / 6, 1);
        b.add_node({.mesh = crown, .translation = at_random(0), .scale = scale, .role = "vegetation"});
    }
    // Twice the same block: every hit on it is a tie.
    for (int n = 0; n < 2; ++n)
        b.add_node({.mesh = block, .translation = glm::dvec3(32, 0, -32)});

    const int glow = b.add_material({});
    auto& material = b.json["materials"][static_cast<std::size_t>(glow)];
    material["emissiveFactor"] = {1, 0.5, 0.25};
    material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 5000;
    b.add_node(
        {.mesh = b.add_mesh(box({-1, 2, -1}, {1, 3, 1}), glow), .translation = glm::dvec3(20, 0, -10)});
    constexpr std::array<const char*, 3> groups = {"", "lanterns", "windows"};
    for (int n = 0; n < size.lamps; ++n) {
        b.add_node({.light = b.add_light({{"type", "point"}, {"intensity", 400 + 10 * n}}),
                    .translation = at_random(3),
                    .light_group = groups[static_cast<std::size_t>(n) % groups.size()]});
    }
    const int spot = b.add_light(
        {{"type", "spot"}, {"intensity", 900}, {"spot", {{"outerConeAngle", 0.7}, {"innerConeAngle", 0.3}}}});
    b.add_node(
        {.light = spot, .translation = glm::dvec3(30, 6, -20), .rotation = glm::dvec4(-0.6, 0, 0, 0.8)});
    return b;
}

std::shared_ptr<bake::World> open_world(const GltfBuilder& builder) {
    static const std::shared_ptr<trace::Device> device = trace::Device::open().value();
    auto map = builder.import();
    EXPECT_TRUE(map) << (map ? "" : map.error());
    auto world = bake::World::open(device, std::make_shared<const map::Map>(std::move(*map)));
    EXPECT_TRUE(world) << (world ? "" : world.error());
    return *world;
}

bake::ProbeLight light_at(bake::World& world, const glm::vec3& position_m, std::uint32_t rays,
                          std::uint32_t bounces, float error) {
    const trace::FloatMode float_mode;
    const auto scene = world.scene_for({static_cast<std::int32_t>(std::floor(position_m.x / 64)),
                                        static_cast<std::int32_t>(std::floor(position_m.y / 64))},
                                       512);
    const bake::SampleTable samples(rays, bake::sample_dimensions(bounces, !world.lights().empty()));
    return bake::integrate_probe(*scene, world.lights(), glm::ivec3(glm::round(position_m * 1024.0f)),
                                 samples, {bounces, 512, error});
}

std::vector<std::uint8_t> encoded(const Sector& sector) {
    std::vector<std::string> warnings;
    auto bytes = bake::encode_sector(sector, warnings);
    EXPECT_TRUE(bytes) << (bytes ? "" : bytes.error());
    return bytes.value_or(std::vector<std::uint8_t>());
}

double under_constant_sky(const bake::ProbeLight& light, std::size_t channel, std::size_t basis) {
    return static_cast<double>(light.transfer[channel][basis][0]) / static_cast<double>(sh_y0);
}

Shape in_gltf(Shape shape) {
    for (glm::vec3& p : shape.positions)
        p = gltf_from_world(p);
    return shape;
}

Shape room(const glm::vec3& low, const glm::vec3& high) {
    Shape shape = box(low, high);
    for (std::size_t n = 0; n + 2 < shape.indices.size(); n += 3)
        std::swap(shape.indices[n + 1], shape.indices[n + 2]);
    return shape;
}

}  // namespace drtv::test
