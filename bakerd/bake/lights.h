// Static lights: what the map itself shines with, in radiometric units, and how to draw from them.
#pragma once

#include "bakerd/map/colour.h"
#include "bakerd/map/map.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drtv::bake {

// glTF's units are photometric. One watt counts as this many lumens (the peak of the eye's efficacy, as
// Blender's exporter has it): candela become W/sr, lux W/m2, nits W/(sr m2), divided by it.
inline constexpr float lumens_per_watt = 683;

using map::brightest;

// Nearer to a point light than this, its inverse square stays as it is: it stands in no surface.
inline constexpr float min_light_distance_m = 0.01f;

// A point or spot light.
struct StaticPointLight {
    glm::vec3 position{};
    glm::vec3 intensity{};                  // W/sr
    float range_m = 0;                      // 0: unlimited
    glm::vec3 direction{};                  // of a spot
    float cone_scale = 0, cone_offset = 1;  // KHR_lights_punctual; (0, 1) shines all around

    // Irradiance of a surface at `point` that faces the light, W/m2, without shadows.
    [[nodiscard]] glm::vec3 irradiance_at(const glm::vec3& point) const;
};

// REQUIRES: it is no directional light.
[[nodiscard]] StaticPointLight point_light(const map::Light& light);

struct StaticSun {
    glm::vec3 towards{};     // unit
    glm::vec3 irradiance{};  // W/m2 of a surface that faces it
};

// One object with emissive triangles; these are drawn by area times emission.
struct EmissiveObject {
    struct Triangle {
        std::uint32_t primitive;
        std::uint32_t triangle;
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

// How much light of a colour counts when lights are weighed against each other.
[[nodiscard]] inline float luminance(const glm::vec3& colour) {
    return colour.x + colour.y + colour.z;
}

// In all objects of the map together.
[[nodiscard]] std::size_t emissive_triangles(const map::Map& map);

// Lights whose static irradiance is kept apart: a light group, or all that are in none.
struct LightSet {
    std::string name;  // empty: of no group
    std::vector<const StaticPointLight*> points;
    std::vector<const StaticSun*> suns;
    std::vector<const EmissiveObject*> emissive;  // in the map's order of objects
};

class StaticLights {
  public:
    explicit StaticLights(std::shared_ptr<const map::Map> map);
    StaticLights(const StaticLights&) = delete;
    StaticLights& operator=(const StaticLights&) = delete;

    [[nodiscard]] bool empty() const { return points_.empty() && suns_.empty() && emissive_.empty(); }
    [[nodiscard]] std::span<const StaticPointLight> points() const { return points_; }
    [[nodiscard]] std::span<const StaticSun> suns() const { return suns_; }
    [[nodiscard]] std::span<const EmissiveObject> emissive() const { return emissive_; }
    [[nodiscard]] const map::Map& map() const { return *map_; }

    // First the lights of no group, which may be none, then the groups by name.
    [[nodiscard]] std::span<const LightSet> sets() const { return sets_; }
    // The set that an object of the map would shine with.
    [[nodiscard]] std::size_t set_of(std::uint32_t object) const {
        return set_of_group(map_->objects[object].light_group);
    }

  private:
    // `group_of_point`, `group_of_sun`: the number of the group of each in the map.
    void make_sets(std::span<const std::uint32_t> group_of_point,
                   std::span<const std::uint32_t> group_of_sun);
    [[nodiscard]] std::size_t set_of_group(std::uint32_t group) const {
        return group == map::no_light_group ? 0 : set_of_group_[group];
    }

    std::shared_ptr<const map::Map> map_;
    std::vector<StaticPointLight> points_;
    std::vector<StaticSun> suns_;
    std::vector<EmissiveObject> emissive_;  // in the map's order of objects
    std::vector<LightSet> sets_;
    std::vector<std::size_t> set_of_group_;  // by number of the group in the map
};

}  // namespace drtv::bake
