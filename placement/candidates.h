// Proposals of one sector and its margin, before any decision between them.
#pragma once

#include "placement/placement.h"

#include <tuple>

namespace drtv::placement {

inline constexpr float probe_height_m = 1;  // above the surface or the box
inline constexpr float min_free_height_m = 1.5f;

// A proposal with its place in the order of priority.
struct Candidate {
    Position position;
    Kind kind = Kind::ground;
    bool moved = false;
    float min_distance_m = 0;         // where it stands
    std::uint32_t lattice_class = 0;  // see lattice_class_of
    std::uint32_t level = 0;          // of several in one column, counted from the bottom
    std::uint64_t hash = 0;           // of the column; decides what the rest leaves open

    // Where probes may stand nearest goes last.
    [[nodiscard]] auto priority() const {
        return std::tuple(
            kind, -min_distance_m, lattice_class, level, hash, position.x, position.y, position.z);
    }
};

// Columns of one class lie at least `min_distance_m` apart, so that they never compete with each other;
// classes are numbered so that each fills the widest gaps the earlier ones leave (Bayer 1973).
[[nodiscard]] std::uint32_t lattice_class_of(std::int32_t a, std::int32_t b, std::uint32_t stride);

// Smallest power of two s for which s lattice steps are at least the distance.
[[nodiscard]] std::uint32_t lattice_stride(float lattice_m, float min_distance_m);

// The side of the lattice's squares.
[[nodiscard]] float lattice_side_m(Kind kind, float min_distance_m);

// [low, high), world metres.
struct Square {
    glm::dvec2 low;
    glm::dvec2 high;
};

// The distances that probes keep: the map's own first, then those of volumes, each once.
[[nodiscard]] std::vector<float> distances_kept(const PlacementSettings& settings,
                                                std::span<const SpacingVolume> spacings);

// All proposals in the square, by priority.
[[nodiscard]] std::vector<Candidate> propose(const Square& square,
                                             const Input& input,
                                             const SceneQueries& queries,
                                             const PlacementSettings& settings);

}  // namespace drtv::placement
