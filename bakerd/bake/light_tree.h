// A tree of the lights that a probe can know of, to draw from.
#pragma once

#include "bakerd/bake/lights.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace drtv::bake {

// Light that cannot bring more than `faint`, W/m2 over the probability of its draw, is kept only so often:
// when the number in [0, 1) is below its share of that. Then it counts as if it brought that much, so that
// nothing is lost on average. A faint of 0 keeps all.
struct Roulette {
    float number = 0;
    float faint = 0;
};

// The lights that a probe can know of, in a tree from which one is drawn with a probability that falls with
// the square of the distance (Conty and Kulla 2018, without their cones). A function of these lights alone.
class LightTree {
  public:
    LightTree(const LightSet& lights, const glm::vec3& centre, float reach_m);

    // One light: points first, then emissive objects.
    struct Item {
        const StaticPointLight* point = nullptr;
        const EmissiveObject* emissive = nullptr;
    };
    struct Drawn {
        Item item;
        float probability = 0;  // of the draw; 0 when it was given up
        float survival = 1;     // of the roulette
        double rest = 0;        // of the number that chose, uniform in [0, 1) again
    };

    [[nodiscard]] bool empty() const { return nodes_.empty(); }
    [[nodiscard]] bool has_emissive() const { return !leaf_of_object_.empty(); }
    [[nodiscard]] std::span<const StaticPointLight* const> points() const { return points_; }
    // REQUIRES: not empty.
    [[nodiscard]] Drawn draw(const glm::vec3& from, double u, const Roulette& roulette) const;
    // The emissive object of that number with the probability with which `draw` gives it; 0 when it is not in
    // the tree.
    [[nodiscard]] Drawn find(const glm::vec3& from, std::uint32_t object) const;

  private:
    struct Node {
        glm::vec3 centre{};
        float radius_m = 0;
        float power = 0;
        std::int32_t parent = -1;
        std::int32_t left = -1;  // below 0: a leaf
        std::int32_t right = -1;
        Item item;
    };
    std::int32_t build(std::span<Node> leaves, std::int32_t parent);
    [[nodiscard]] float share_of_left(const Node& node, const glm::vec3& from) const;

    std::vector<Node> nodes_;
    std::vector<const StaticPointLight*> points_;
    std::vector<std::pair<std::uint32_t, std::int32_t>> leaf_of_object_;  // sorted by object
};

}  // namespace drtv::bake
