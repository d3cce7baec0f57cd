// Light that comes straight from a static light to a point: punctual lights, suns, points of emissive
// surfaces.
#pragma once

#include "bakerd/bake/light_tree.h"
#include "bakerd/bake/lights.h"
#include "bakerd/trace/scene.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>

namespace drtv::bake {

// Irradiance of a surface that faces `direction`; or for `density` > 0 radiance along it, drawn with that
// density.
struct Incident {
    glm::vec3 direction{};
    glm::vec3 light{};                // already divided by the probability of the draw
    std::optional<glm::vec3> target;  // the light's place; none of a sun
    float distance_m = 0;             // of the light; of a sun, to the end of the reach
    float density = 0;  // per steradian with which next event draws this direction; 0: no path could find it
};

// Of one probe: the lights of a set within its reach, and shadows inside it.
class NextEvent {
  public:
    NextEvent(const trace::Scene& scene, const LightSet& lights, const glm::vec3& probe, float reach_m)
        : scene_(scene), lights_(lights), tree_(lights, probe, reach_m), probe_(probe), reach_m_(reach_m) {}

    [[nodiscard]] bool idle() const { return tree_.empty() && lights_.suns.empty(); }
    [[nodiscard]] bool has_drawn_lights() const { return !tree_.empty(); }
    [[nodiscard]] bool has_emissive() const { return tree_.has_emissive(); }
    [[nodiscard]] std::span<const StaticPointLight* const> points() const { return tree_.points(); }
    [[nodiscard]] std::span<const StaticSun* const> suns() const { return lights_.suns; }

    [[nodiscard]] Incident towards(const StaticPointLight& light, const glm::vec3& from) const;
    [[nodiscard]] Incident towards(const StaticSun& sun, const glm::vec3& from) const;
    // One light of the tree by the three numbers; nothing where the draw sends no light.
    [[nodiscard]] std::optional<Incident> draw(const glm::vec3& from,
                                               const std::array<double, 3>& u,
                                               const Roulette& roulette) const;

    // The density with which `draw` gives the direction in which a path from `from` has hit an emissive
    // surface, per steradian.
    [[nodiscard]] float density_of(const glm::vec3& from,
                                   const glm::vec3& direction,
                                   const trace::Hit& hit) const;

    // The ray on which nothing may lie, from `start`, a free point on the right side. A light with a place
    // may lie on a surface (trace::Scene::hides_surface).
    [[nodiscard]] static trace::Ray shadow_ray(const glm::vec3& start, const Incident& incident);

  private:
    const trace::Scene& scene_;
    const LightSet& lights_;
    const LightTree tree_;
    const glm::vec3 probe_;
    const float reach_m_;
};

}  // namespace drtv::bake
