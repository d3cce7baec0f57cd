#include "bakerd/reuse/static_gain.h"

#include "bakerd/bake/ray_watch.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <vector>

namespace drtv::reuse {
namespace {

// Nearer to a lamp than this counts as this: far above any tolerance all the same.
constexpr float min_distance_m = 0.001f;

// Of light of that radiance at each of so many points of a path.
float of_path(float radiance, float scattered, std::uint32_t points) {
    float sum = 0;
    float left = 1;
    for (std::uint32_t point = 0; point < points; ++point, left *= scattered)
        sum += left;
    return sum * radiance / bake::static_irradiance_range;
}

// A lamp, and how near to it a surface can be.
struct NearLamp {
    glm::vec3 position;
    float intensity;  // of its brightest channel, W/sr
    float distance_m;
};

float irradiance(const NearLamp& lamp, float distance_m) {
    return lamp.intensity / (distance_m * distance_m);
}

// What all lamps together bring at most to any one surface. A point that has one of them nearest is at least
// half way from that to each other.
float max_irradiance(const std::vector<NearLamp>& lamps) {
    constexpr std::size_t max_in_pairs = 2048;
    float most = 0;
    float sum = 0;
    for (const NearLamp& lamp : lamps)
        sum += irradiance(lamp, lamp.distance_m);
    if (lamps.size() > max_in_pairs)
        return sum;
    for (const NearLamp& nearest : lamps) {
        float together = irradiance(nearest, nearest.distance_m);
        for (const NearLamp& lamp : lamps) {
            if (&lamp != &nearest)
                together += irradiance(
                    lamp, std::max(lamp.distance_m, glm::distance(lamp.position, nearest.position) / 2));
        }
        most = std::max(most, together);
    }
    return most;
}

}  // namespace

float static_gain(const bake::StaticLights& lights,
                  float scattered,
                  const trace::Scene& scene,
                  std::span<const placement::Position> probes,
                  const settings::BakeSettings& settings) {
    const auto within_reach = [&](const glm::vec3& place, float radius_m) {
        return std::ranges::any_of(probes, [&](const placement::Position& probe) {
            return glm::distance(placement::metres(probe), place) - radius_m <= settings.reach_m;
        });
    };
    std::vector<NearLamp> lamps;
    for (const bake::StaticPointLight& lamp : lights.points()) {
        if (within_reach(lamp.position, 0))
            lamps.push_back(
                {lamp.position,
                 bake::brightest(lamp.intensity),
                 std::max(scene.distance_to_surface(lamp.position, settings.reach_m), min_distance_m)});
    }
    float irradiance = max_irradiance(lamps);
    float emitted = 0;
    for (const bake::StaticSun& sun : lights.suns())
        irradiance += bake::brightest(sun.irradiance);
    for (const bake::EmissiveObject& emissive : lights.emissive()) {
        if (within_reach(emissive.centre, emissive.radius_m))
            emitted = std::max(emitted, emissive.radiance);
    }
    // Emission is met at the end of the last ray too.
    return of_path(irradiance * scattered * std::numbers::inv_pi_v<float>, scattered, settings.bounces) +
           of_path(emitted, scattered, settings.bounces + 1);
}

// Any point of a box is at least as far from each lamp as the box.
float static_gain(const bake::StaticLights& lights,
                  float scattered,
                  std::span<const map::Bounds> boxes,
                  const settings::BakeSettings& settings) {
    float most = 0;
    for (const map::Bounds& box : boxes) {
        float irradiance = 0;
        for (const bake::StaticPointLight& lamp : lights.points()) {
            const float distance_m = std::max(
                glm::distance(lamp.position, glm::clamp(lamp.position, box.low, box.high)), min_distance_m);
            // Beyond, none that a probe knows of shines on what it can see.
            if (distance_m <= 2 * settings.reach_m)
                irradiance += bake::brightest(lamp.intensity) / (distance_m * distance_m);
        }
        most = std::max(most, irradiance);
    }
    return of_path(most * scattered * std::numbers::inv_pi_v<float>, scattered, settings.bounces);
}

// Each of its terms has at most so many surfaces in it.
float raised_gain(float gain,
                  float scattered_before,
                  float scattered_now,
                  const settings::BakeSettings& settings) {
    for (std::uint32_t bounce = 0; scattered_now > scattered_before && bounce < settings.bounces; ++bounce)
        gain *= scattered_now / scattered_before;
    return gain;
}

}  // namespace drtv::reuse
