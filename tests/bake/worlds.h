// Worlds for tests of the bake, out of glTF written in memory.
#pragma once

#include "bakerd/bake/integrate.h"
#include "bakerd/bake/world.h"
#include "tests/map/gltf_builder.h"

#include <drtv/sector.h>

#include <memory>
#include <vector>

namespace drtv::test {

// REQUIRES: the map imports and its volumes are closed.
[[nodiscard]] std::shared_ptr<bake::World> open_world(const GltfBuilder& builder);

// Light at a world position in metres; rays and bounces as given, reach 512 m.
[[nodiscard]] bake::ProbeLight light_at(bake::World& world, const glm::vec3& position_m, std::uint32_t rays, std::uint32_t bounces = 3, float error = 0);

// The sector's file. REQUIRES: it passes the validator.
[[nodiscard]] std::vector<std::uint8_t> encoded(const Sector& sector);

// Sum over i of T[c][b][i] and a constant sky of radiance 1.
[[nodiscard]] double under_constant_sky(const bake::ProbeLight& light, std::size_t channel, std::size_t basis);

// A box with its fronts inwards: a room.
[[nodiscard]] Shape room(const glm::vec3& low, const glm::vec3& high);

}  // namespace drtv::test
