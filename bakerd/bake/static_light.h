// Static light of one set of lights on the paths of one probe: at each of their points one light is drawn,
// and emissive surfaces count both when they are drawn and when a path meets them, by the balance heuristic
// (Veach 1997). What a set brings is a function of its lights and of the paths: not of the other sets.
#pragma once

#include "bakerd/bake/integrate.h"
#include "bakerd/bake/light_sums.h"
#include "bakerd/bake/next_event.h"
#include "bakerd/bake/probe_sums.h"
#include "bakerd/bake/ray_watch.h"
#include "bakerd/bake/sampling.h"
#include "bakerd/trace/scene.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <numbers>

namespace drtv::bake {

// All that stays the same while one probe is integrated.
struct ProbeTask {
    const trace::Scene& scene;
    const SampleTable& samples;
    const IntegrationSettings& settings;
    glm::vec3 probe;  // metres
    std::array<std::uint32_t, max_sample_dimensions> shift;
    RayWatch* watch;  // may be none
};

// Of the first directions, per steradian.
inline constexpr float uniform_density = 0.25f * std::numbers::inv_pi_v<float>;

// A path where it stands.
struct Path {
    std::uint32_t number;
    std::uint32_t bounce = 0;  // surfaces behind it
    trace::Ray ray;            // that goes on from there
    BasisWeights weights;      // of its first direction
    Half half;
    glm::vec3 throughput{1};          // what radiance from the ray's direction counts at the probe
    float density = uniform_density;  // per steradian, of the ray's direction
    float footprint_m = 0;            // width over which textures are averaged
};

// What a change can alter of something that counts `weight` for a path of these weights.
[[nodiscard]] inline Shares shares_of(const BasisWeights& weights, float weight) {
    return {weights[0] * weight, weights[1] * weight, weights[2] * weight, weights[3] * weight};
}

// Sample numbers that the draw of a light takes at each point of a path.
inline constexpr std::uint32_t numbers_per_light = 3;

class StaticLight {
  public:
    StaticLight(const ProbeTask& task, const LightSet& lights)
        : task_(task), next_event_(task.scene, lights, task.probe, task.settings.reach_m) {}

    // Whether no light is within reach. REQUIRES of all that follows: there is one.
    [[nodiscard]] bool idle() const { return next_event_.idle(); }
    [[nodiscard]] LightSums& sums() { return sums_; }
    [[nodiscard]] const LightSums& sums() const { return sums_; }
    [[nodiscard]] std::uint64_t shadow_rays() const { return shadow_rays_; }

    // An emissive surface drawn at the probe; other lights are summed up without noise by add_direct.
    void add_drawn_at_probe(std::uint32_t path_number);
    // Radiance that the path met on an emissive surface.
    void add_met(const Path& path, const trace::Hit& hit, const glm::vec3& emission);
    // Light by way of the surface that the path met.
    void add_at_surface(const Path& path, const trace::Hit& hit, const trace::Surface& surface);
    // Of lamps and suns, straight to the probe.
    void add_direct();

  private:
    void add_incident(const Path& path,
                      const trace::Hit& hit,
                      const trace::Surface& surface,
                      const Incident& incident);
    [[nodiscard]] std::array<double, numbers_per_light> light_sample(std::uint32_t path_number,
                                                                     std::uint32_t point) const;
    [[nodiscard]] bool survives(glm::vec3& light, std::uint32_t path_number, std::uint32_t draw) const;
    // `light` times `weights` is what a ray brings to the static irradiance where nothing hides its light.
    // The share of it that comes to `start`; by chance, of one ray among many.
    [[nodiscard]] glm::vec3 share_seen(const glm::vec3& start,
                                       const Incident& incident,
                                       const BasisWeights& weights,
                                       const glm::vec3& light);
    // Counts the ray, and tells of it.
    [[nodiscard]] trace::Ray shadow_ray(const glm::vec3& start,
                                        const Incident& incident,
                                        const BasisWeights& weights,
                                        const glm::vec3& light);

    const ProbeTask& task_;
    LightSums sums_;
    const NextEvent next_event_;
    std::uint64_t shadow_rays_ = 0;
};

}  // namespace drtv::bake
