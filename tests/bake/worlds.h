// Worlds for tests of the bake, out of glTF written in memory.
#pragma once

#include "bakerd/bake/integrate.h"
#include "bakerd/bake/world.h"
#include "tests/map/gltf_builder.h"

#include <drtv/sector.h>

#include <memory>
#include <numeric>
#include <vector>

namespace drtv::test {

// REQUIRES: the map imports and its volumes are closed.
[[nodiscard]] std::shared_ptr<bake::World> open_world(const GltfBuilder& builder);

struct Clutter {
    float low_m = -90, high_m = 150;  // where it stands, east and north
    float ground_m = 200;             // half a side
    int blocks = 25, crowns = 60, lamps = 12;
};

// All that a sector can hold, at random places: turned blocks, crowns of leaves, two blocks in one place, a
// glowing one, point lights, two in three of them in one of two light groups, and a spot light. No number of
// it comes from the C library's functions, so it is the same on every CPU.
[[nodiscard]] GltfBuilder clutter(const Clutter& size);

// Light at a world position in metres; rays and bounces as given, reach 512 m.
[[nodiscard]] bake::ProbeLight light_at(bake::World& world, const glm::vec3& position_m, std::uint32_t rays,
                                        std::uint32_t bounces = 3, float error = 0);

// The sector's file. REQUIRES: it passes the validator.
[[nodiscard]] std::vector<std::uint8_t> encoded(const Sector& sector);

// Sum over i of T[c][b][i] and a constant sky of radiance 1.
[[nodiscard]] double under_constant_sky(const bake::ProbeLight& light, std::size_t channel,
                                        std::size_t basis);

// A shape given in world axes, as glTF has it.
[[nodiscard]] Shape in_gltf(Shape shape);

// A box with its fronts inwards: a room.
[[nodiscard]] Shape room(const glm::vec3& low, const glm::vec3& high);

// Every source to each receiver, of as many of both.
[[nodiscard]] inline std::vector<std::vector<std::uint32_t>> all_pairs(std::size_t count) {
    std::vector<std::uint32_t> all(count);
    std::iota(all.begin(), all.end(), 0u);
    return std::vector<std::vector<std::uint32_t>>(count, all);
}

}  // namespace drtv::test
