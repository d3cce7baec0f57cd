#include "tests/bake/worlds.h"

#include "bakerd/bake/sector_bake.h"

#include <gtest/gtest.h>

#include <cmath>

namespace drtv::test {

std::shared_ptr<bake::World> open_world(const GltfBuilder& builder) {
    static const std::shared_ptr<trace::Device> device = trace::Device::open().value();
    auto map = builder.import();
    EXPECT_TRUE(map) << (map ? "" : map.error());
    auto world = bake::World::open(device, std::make_shared<const map::Map>(std::move(*map)));
    EXPECT_TRUE(world) << (world ? "" : world.error());
    return *world;
}

bake::ProbeLight light_at(bake::World& world, const glm::vec3& position_m, std::uint32_t rays, std::uint32_t bounces, float error) {
    const trace::FloatMode float_mode;
    const auto scene = world.scene_for({static_cast<std::int32_t>(std::floor(position_m.x / 64)), static_cast<std::int32_t>(std::floor(position_m.y / 64))}, 512);
    const bake::SampleTable samples(rays, bake::sample_dimensions(bounces, !world.lights().empty()));
    return bake::integrate_probe(*scene, world.lights(), glm::ivec3(glm::round(position_m * 1024.0f)), samples, {bounces, 512, error});
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

Shape room(const glm::vec3& low, const glm::vec3& high) {
    Shape shape = box(low, high);
    for (std::size_t n = 0; n + 2 < shape.indices.size(); n += 3) std::swap(shape.indices[n + 1], shape.indices[n + 2]);
    return shape;
}

}  // namespace drtv::test
