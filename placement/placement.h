// Automatic placement of probes in one sector (s14-s17).
//
// Columns on the global 4 m lattice propose a probe above every up-facing surface; columns on the 8 m lattice
// propose one on top of the vegetation's combined bounding boxes. Proposals closer than the minimal distance
// are decided by a rule that needs no order of work: two sectors decide alike about their common border, each
// by itself, because a decision depends only on proposals within `decision_margin_m`.
#pragma once

#include "placement/closed_volume.h"
#include "placement/solid_test.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::placement {

// Positions are whole multiples of 2^-10 m, so that all distances are compared exactly.
inline constexpr std::int32_t units_per_m = 1024;
inline constexpr std::int32_t sector_size_m = 64;
inline constexpr std::size_t max_probes = 255;

// Columns stand in the middles of these squares of the world.
inline constexpr std::int32_t ground_lattice_m = 4;      // s15
inline constexpr std::int32_t vegetation_lattice_m = 8;  // s16

using Position = glm::ivec3;  // world, in units of 2^-10 m

[[nodiscard]] glm::vec3 metres(const Position& position);

struct Settings {
    float min_distance_m = 6;  // between automatic probes, 1 to 16: beyond, the margin below grows past 500 m
};

struct ColumnHit {
    float z_m = 0;
    bool up_facing = false;    // seen from above it is a front
    bool down_facing = false;  // seen from below it is a front
};

struct Box {
    glm::vec3 low, high;  // world, metres
};

// The scene, as functions. Each must be a pure function of its arguments; they are called from one thread.
struct Surroundings {
    // All crossings of the vertical line at (x, y) with static objects, from the top down; replaces the
    // vector.
    std::function<void(glm::vec2, std::vector<ColumnHit>&)> column;
    // Of rays from a point, how many meet the back of a one-sided surface first.
    std::function<std::size_t(const glm::vec3& origin, std::span<const glm::vec3> directions)> backs_met;
    // Whether the straight line between two points is free.
    std::function<bool(const glm::vec3&, const glm::vec3&)> sees;
};

enum class Kind : std::uint8_t { ground, vegetation, manual };

struct PlacedProbe {
    Position position;
    Kind kind = Kind::ground;
};

struct Report {
    std::uint32_t candidates = 0;         // proposals inside the sector
    std::uint32_t moved_out = 0;          // probes moved out of a solid
    std::uint32_t dropped_in_solid = 0;   // no free place within half the spacing
    std::uint32_t removed_by_volume = 0;  // inside a no_probes volume
    std::uint32_t thinned = 0;            // given up to stay within 255
    float used_distance_m = 0;            // the minimal distance in the end
};

struct Placement {
    std::vector<PlacedProbe> probes;  // manual ones first, then by (y, x, z)
    Report report;
};

struct Input {
    std::int32_t i = 0, j = 0;                // the sector
    std::span<const Box> vegetation;          // all that overlap the sector grown by decision_margin_m
    std::span<const glm::dvec3> manual;       // all manual probes of the map
    std::span<const ClosedVolume> no_probes;  // all such volumes of the map
};

// How far from the sector's border the surroundings are asked: columns, vegetation, rays' origins.
[[nodiscard]] float decision_margin_m(const Settings& settings);

// Fails with a sentence when the sector holds more than 255 manual probes.
[[nodiscard]] tl::expected<Placement, std::string> place_probes(const Input& input,
                                                                const Surroundings& surroundings,
                                                                const Settings& settings);

}  // namespace drtv::placement
