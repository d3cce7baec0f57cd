// What the ends of paths from one source do for a pair of sources, in groups: as a bounce from a light at the
// other source and, read the other way, to a receiver there.
#pragma once

#include "bakerd/bake/local_transfer.h"

#include <drtv/conventions.h>

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace drtv::bake {

// The end of a path from source p after one or more bounces, seen from the point that other sources would
// light.
struct PathEnd {
    glm::vec3 position{};
    glm::vec3 normal{};  // on the side from which the path came
    // Starts of shadow rays: on that side, and on the other where light goes through.
    glm::vec3 before{};
    std::optional<glm::vec3> beyond;
    // Times what the points before send on.
    glm::vec3 albedo{};
    glm::vec3 transmitted{};
    float density = 0;  // of finding it from p, but for what both directions share
    // Of going on from here to the path's first point, from either side.
    float density_front = 1;
    float density_back = 0;
    float to_receiver = 0;    // cosine over square distance of the first point to p
    float from_light = 0;     // irradiance of the first point from a light at p
    Float4 direction{};       // SH of E/pi at p from the first point's direction
    glm::vec3 first{};        // the first point
    glm::vec3 share_back{1};  // of light that goes back from the first point to p: by glass on that way
};

// Ends of paths that left their source side by side.
inline constexpr std::uint32_t group_size = 16;  // a power of two

// The numbers of up to group_size ends as join() reads them, one after the other: so the compiler takes eight
// at a time. Behind the last end all are such that nothing comes of them.
struct EndGroup {
    using Numbers = std::array<float, group_size>;

    std::vector<PathEnd> ends;
    alignas(32) Numbers x{}, y{}, z{};
    alignas(32) Numbers normal_x{}, normal_y{}, normal_z{};
    alignas(32) Numbers first_x{}, first_y{}, first_z{};
    alignas(32) Numbers density{}, density_front{}, density_back{};
    alignas(32) Numbers to_receiver{}, from_light{};
    // What it sends on, summed over channels; 0 where it has no such side.
    alignas(32) Numbers bright_front{}, bright_back{};

    // REQUIRES: fewer than group_size ends.
    void add(const PathEnd& end);
};

// What the ends of a group do for one pair.
struct Links {
    std::size_t partner = 0;                 // the number of the other source, q, among the paths' partners
    alignas(32) EndGroup::Numbers strength;  // what each brings, for the draw; 0: nothing
    alignas(32) EndGroup::Numbers here, there;  // to receivers here and there, but for colour and direction
    alignas(32) EndGroup::Numbers way_x, way_y, way_z;  // from q, unit
    alignas(32) EndGroup::Numbers facing;  // negative where q is on the other side of the surface
    glm::vec3 tint{1};                     // of glass on the way to q
    bool turns_back = false;               // q is p, and the way to it the one that the paths came
};

// Of the paths that a group belongs to.
struct GroupPaths {
    std::uint32_t count;  // from each source
    float reach_m;
};

// Sets all of `links` but its source, for the other source at `other` (metres), which is the paths' own
// source where `own` says so. Gives the sum of all strengths.
[[nodiscard]] float join(
    const EndGroup& group, const GroupPaths& paths, const glm::vec3& other, bool own, Links& links);

// What the paths of one source brought, by partner: the other source of a pair.
struct Brought {
    std::vector<LocalCoefficients> here;   // to a receiver where the paths began, from a light at the other
    std::vector<LocalCoefficients> there;  // to a receiver at the other, from a light where the paths began
    std::uint64_t rays = 0;
};

// Adds what the links bring. Only what has a receiver is wanted.
void add_links(
    const EndGroup& group, const Links& links, bool wants_here, bool wants_there, Brought& brought);

// SH of E/pi from radiance out of the unit direction: the cosine's own coefficients over pi are 1 and 2/3.
[[nodiscard]] Float4 irradiance_sh(const glm::vec3& direction);

}  // namespace drtv::bake
