// Static lights: what the map itself shines with, in radiometric units, and how to draw from them.
#pragma once

#include "bakerd/map/map.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace drtv::bake {

// glTF's units are photometric. One watt counts as this many lumens (the peak of the eye's efficacy, as
// Blender's exporter has it): candela become W/sr, lux W/m2, nits W/(sr m2), divided by it.
inline constexpr float lumens_per_watt = 683;

// Its largest channel.
[[nodiscard]] inline float brightest(const glm::vec3& colour) {
    return std::max({colour.x, colour.y, colour.z});
}

// Nearer to a point light than this, its inverse square stays as it is: it stands in no surface.
inline constexpr float least_light_distance_m = 0.01f;

// A point or spot light.
struct PointLight {
    glm::vec3 position{};
    glm::vec3 intensity{};                  // W/sr
    float range_m = 0;                      // 0: unlimited
    glm::vec3 direction{};                  // of a spot
    float cone_scale = 0, cone_offset = 1;  // KHR_lights_punctual; (0, 1) shines all around

    // Irradiance of a surface at `point` that faces the light, W/m2, without shadows.
    [[nodiscard]] glm::vec3 irradiance_at(const glm::vec3& point) const;
};

struct Sun {
    glm::vec3 towards{};     // unit
    glm::vec3 irradiance{};  // W/m2 of a surface that faces it
};

// One object with emissive triangles; these are drawn by area times emission.
struct EmissiveObject {
    struct Triangle {
        std::uint32_t primitive, triangle;
        glm::vec3 a, b, c;  // world, counter-clockwise seen from the front
        bool both_sides;
        float share;         // the probability of being drawn
        float share_before;  // sum of those before it
    };
    std::uint32_t object = 0;  // of the map
    glm::vec3 centre{};
    float radius_m = 0;
    float power = 0;                  // W / pi, about
    float radiance = 0;               // of its brightest material, at most, W/(sr m2)
    std::vector<Triangle> triangles;  // by primitive and triangle
    std::vector<std::vector<std::uint32_t>>
        numbers;  // [primitive][triangle] -> index into triangles, or UINT32_MAX

    [[nodiscard]] const Triangle* find(std::uint32_t primitive, std::uint32_t triangle) const;
};

// A dark light is none.
[[nodiscard]] bool shines(const map::Light& light);

// In all objects of the map together.
[[nodiscard]] std::size_t emissive_triangles(const map::Map& map);

class StaticLights {
  public:
    explicit StaticLights(std::shared_ptr<const map::Map> map);

    [[nodiscard]] bool empty() const { return points_.empty() && suns_.empty() && emissive_.empty(); }
    [[nodiscard]] std::span<const PointLight> points() const { return points_; }
    [[nodiscard]] std::span<const Sun> suns() const { return suns_; }
    [[nodiscard]] std::span<const EmissiveObject> emissive() const { return emissive_; }
    [[nodiscard]] const map::Map& map() const { return *map_; }

  private:
    std::shared_ptr<const map::Map> map_;
    std::vector<PointLight> points_;
    std::vector<Sun> suns_;
    std::vector<EmissiveObject> emissive_;  // in the map's order of objects
};

// Light that cannot bring more than `faint`, W/m2 over the probability of its draw, is kept only so often:
// when the number in [0, 1) is below its share of that. Then it counts as if it brought that much, so that
// nothing is lost on average. A faint of 0 keeps all.
struct Roulette {
    float number = 0, faint = 0;
};

// The lights that a probe can know of, in a tree from which one is drawn with a probability that falls with
// the square of the distance (Conty and Kulla 2018, without their cones). A function of these lights alone.
class LightTree {
  public:
    LightTree(const StaticLights& lights, const glm::vec3& centre, float reach_m);

    // One light: points first, then emissive objects.
    struct Item {
        const PointLight* point = nullptr;
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
    [[nodiscard]] std::span<const PointLight* const> points() const { return points_; }
    // REQUIRES: not empty.
    [[nodiscard]] Drawn draw(const glm::vec3& from, double u, const Roulette& roulette) const;
    // The emissive object of that number with the probability with which `draw` gives it; 0 when it is not in
    // the tree.
    [[nodiscard]] Drawn find(const glm::vec3& from, std::uint32_t object) const;

  private:
    struct Node {
        glm::vec3 centre{};
        float radius_m = 0, power = 0;
        std::int32_t parent = -1, left = -1, right = -1;  // left < 0: a leaf
        Item item;
    };
    std::int32_t build(std::span<Node> leaves, std::int32_t parent);
    [[nodiscard]] float share_of_left(const Node& node, const glm::vec3& from) const;

    std::vector<Node> nodes_;
    std::vector<const PointLight*> points_;
    std::vector<std::pair<std::uint32_t, std::int32_t>> leaf_of_object_;  // sorted by object
};

}  // namespace drtv::bake
