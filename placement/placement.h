// Automatic placement of probes in one sector (slides 14 to 17).
//
// Columns on a global lattice propose a probe above every up-facing surface; columns on a lattice twice as
// wide propose one on top of the vegetation's combined bounding boxes. A proposal yields to one of higher
// priority that is nearer than the minimal distance and that it sees. That is decided by a rule that needs no
// order of work: two sectors decide alike about their common border, each by itself, because a decision
// depends only on proposals within `decision_margin_m`.
#pragma once

#include "placement/closed_volume.h"
#include "placement/crossings.h"

#include <drtv/conventions.h>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace drtv::placement {

// Positions are whole multiples of 2^-10 m, so that all distances are compared exactly.
inline constexpr std::int32_t units_per_m = position_units_per_m;

// Columns stand in the middles of squares of the world with this side: slides 15 and 16. Where probes may
// stand nearer than 4 m, the squares are as small as that, and twice for vegetation.
inline constexpr float ground_lattice_m = 4;
inline constexpr float vegetation_lattice_m = 8;

using Position = glm::ivec3;  // world, in units of 2^-10 m

[[nodiscard]] inline glm::vec3 metres(const Position& position) {
    return glm::vec3(position) * (1.0f / units_per_m);
}

struct PlacementSettings {
    float min_distance_m = 6;  // between automatic probes, 1 to 16: beyond, the margin below grows past 500 m
};

struct Box {
    glm::vec3 low, high;  // world, metres
};

// An object of the scene, by a number of the scene's own.
using Thing = std::uint32_t;

// A ray from a point that is asked for what it meets first.
struct Look {
    glm::vec3 direction{};  // unit
    float far_m = 0;
};

// Of several looks. The corners' order tells fronts from backs, whatever the material's sides are.
struct Met {
    std::size_t backs = 0;
    std::size_t misses = 0;
    std::optional<Thing> behind;  // whose back most of them met
};

// The scene, as functions. Each must be a pure function of its arguments; they are called from one thread.
struct SceneQueries {
    // All crossings of the vertical line at (x, y) with static objects, from the top down; replaces the
    // vector.
    std::function<void(glm::vec2, std::vector<ColumnHit>&)> column;
    // The same, and all that bounds volumes.
    std::function<void(glm::vec2, std::vector<ColumnHit>&)> column_of_spaces;
    // What closed surfaces bound and the point is inside of, whatever their sides and role.
    std::function<std::optional<Thing>(const glm::vec3&)> closed_around;
    // One look after the other, until so many have missed.
    std::function<Met(const glm::vec3& origin, std::span<const Look> looks, std::size_t max_misses)>
        first_met;
    // An object with a surface nearer than that, static or bounding a volume.
    std::function<std::optional<Thing>(const glm::vec3&, float within_m)> wall_within;
    // Static surfaces, and those that bound volumes, on the straight way; in any order.
    std::function<std::vector<Side>(const glm::vec3& from, const glm::vec3& to)> sides;
    // Whether something static and opaque stands between two points; leaves never do.
    std::function<bool(const glm::vec3&, const glm::vec3&)> separated;
    // Whether anything stands between two points.
    std::function<bool(const glm::vec3&, const glm::vec3&)> hidden;
};

enum class Kind : std::uint8_t { ground, vegetation, manual };

struct PlacedProbe {
    Position position;
    Kind kind = Kind::ground;
    bool moved = false;  // out of a solid
};

// Where a point stands.
enum class Stand : std::uint8_t {
    free,
    in_wall,   // on a static surface: half of its light is that of the other side
    in_solid,  // inside what closed surfaces bound
    behind,    // behind surfaces that are not closed, as under the ground
};

// A point that was tested for a solid.
struct SolidTest {
    Position position;
    std::uint8_t to_flip = 0;  // rays that would have to end otherwise for the answer to change
    bool operator==(const SolidTest&) const = default;
};

// A hand-placed probe that does not stand free. It stays.
struct BuriedManual {
    Position position;
    Stand stand = Stand::free;
    Thing thing = 0;  // in or behind which it stands
};

struct PlacementReport {
    std::uint32_t candidates = 0;         // proposals inside the sector
    std::uint32_t moved_out = 0;          // probes moved out of a solid
    std::uint32_t dropped_in_solid = 0;   // no free place within half the distance
    std::uint32_t removed_by_volume = 0;  // inside a no_probes volume
    std::uint32_t thinned = 0;            // given up to stay within 255
    float used_distance_m = 0;            // the minimal distance in the end
};

struct Placement {
    std::vector<PlacedProbe> probes;  // manual ones first, then by (y, x, z)
    PlacementReport report;
    std::vector<Thing> dropped_in;  // of each proposal of the sector that was dropped, what it stood in
    std::vector<BuriedManual> buried_manual;  // of the sector
    std::vector<SolidTest> solid_tests;       // on which all this rests
};

// A probe that interiors name serves these alone: it takes no probe's place outside of them.
struct HandPlacedProbe {
    glm::dvec3 position{};
    std::vector<const ClosedVolume*> interiors;
};

// Inside of it automatic probes keep another distance.
struct SpacingVolume {
    ClosedVolume volume;
    float min_distance_m = 0;  // 1 to 8
};

struct Input {
    std::int32_t i = 0, j = 0;                // the sector
    std::span<const Box> vegetation;          // all that overlap the sector grown by decision_margin_m
    std::span<const HandPlacedProbe> manual;  // all manual probes of the map
    std::span<const ClosedVolume> no_probes;  // all such volumes of the map
    std::span<const SpacingVolume> spacings;  // likewise; where they overlap the smallest distance counts
};

// How far from the sector's border the queries are asked: columns, vegetation, rays' origins.
[[nodiscard]] float decision_margin_m(const PlacementSettings& settings,
                                      std::span<const SpacingVolume> spacings);

// Fails with a sentence when the sector holds more than 255 manual probes.
[[nodiscard]] tl::expected<Placement, std::string> place_probes(const Input& input,
                                                                const SceneQueries& queries,
                                                                const PlacementSettings& settings);

}  // namespace drtv::placement
