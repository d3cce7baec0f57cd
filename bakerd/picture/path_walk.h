// Paths from one place through a scene in the light of a moment.
#pragma once

#include "bakerd/bake/next_event.h"
#include "bakerd/bake/sampling.h"
#include "bakerd/picture/moment.h"
#include "bakerd/picture/scenery.h"
#include "bakerd/picture/show.h"
#include "bakerd/picture/surface_point.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <numbers>
#include <vector>

namespace drtv::picture {

struct PathSettings {
    std::uint32_t bounces = 3;
    std::uint32_t local_bounces = 2;  // of the game's lamps
    float reach_m = 512;              // farther from the place is sky
};

// E/pi by part, as drtv::AmbientParts has it; of sun and lamps, what surfaces send back.
struct PathParts {
    glm::vec3 sky_direct{};
    glm::vec3 sky_bounce{};
    glm::vec3 sun_bounce{};
    glm::vec3 static_light{};
    glm::vec3 local{};

    [[nodiscard]] glm::vec3 total() const {
        return sky_direct + sky_bounce + sun_bounce + static_light + local;
    }
    void add(const PathParts& parts, const glm::vec3& weight);
};
// As part_of an Ambient (painter.h).
[[nodiscard]] glm::vec3 part_of(const PathParts& truth, Show show);

struct PathScene {
    const Scenery& scenery;
    const Moment& moment;
    PathSettings settings;
    std::vector<glm::vec3> factors;  // of the map's sets of lights
};

class PathWalk {
  public:
    PathWalk(const PathScene& scene,
             const glm::vec3& place,
             const bake::SampleTable& paths,
             const glm::ivec3& seed);

    // Two of the path's numbers, for its first direction.
    [[nodiscard]] glm::vec2 first_numbers(std::uint32_t path) const {
        return bake::shifted(paths_.point(path), shift_, 0);
    }

    // What comes along one direction, which is drawn with that density.
    [[nodiscard]] PathParts radiance(std::uint32_t path, const glm::vec3& direction, float density) const;

    // Of lamps and suns of the map, straight to the place. Calls use(direction, E/pi of what faces it).
    template <class Use>
    void direct(const Use& use) const {
        for (std::size_t set = 0; set < events_.size(); ++set) {
            const bake::NextEvent& event = events_[set];
            for (const bake::StaticSun* sun : event.suns())
                use_seen(event.towards(*sun, place_), scene_.factors[set], use);
            for (const bake::StaticPointLight* lamp : event.points())
                use_seen(event.towards(*lamp, place_), scene_.factors[set], use);
        }
    }

    // Of glowing surfaces, drawn at the place: with paths that start with density(direction) they count both
    // ways, by the balance heuristic. Calls use(direction, E/pi of what faces it).
    template <class Density, class Use>
    void drawn(std::uint32_t path, const Density& density, const Use& use) const {
        for (std::size_t set = 0; set < events_.size(); ++set) {
            if (!events_[set].has_emissive())
                continue;
            const auto incident = events_[set].draw(place_, light_numbers(path, set, 0), {});
            if (!incident || !(incident->density > 0))
                continue;
            const float share = incident->density / (incident->density + density(incident->direction));
            use_seen(*incident, scene_.factors[set] * share, use);
        }
    }

  private:
    // A path where it stands.
    struct State {
        std::uint32_t number = 0;
        trace::Ray ray;
        glm::vec3 throughput{1};
        float density = 0;  // of the ray's direction
        float footprint_m = 0;
        std::uint32_t bounce = 0;
    };

    template <class Use>
    void use_seen(const bake::Incident& incident, const glm::vec3& factor, const Use& use) const {
        if (incident.light * factor == glm::vec3(0))
            return;
        const trace::Ray ray = bake::NextEvent::shadow_ray(place_, incident);
        const glm::vec3 share = tracing_.share_seen(ray, incident.target.has_value());
        use(incident.direction, incident.light * factor * share * std::numbers::inv_pi_v<float>);
    }

    [[nodiscard]] std::array<double, 3> light_numbers(std::uint32_t path,
                                                      std::size_t set,
                                                      std::uint32_t point) const;
    void add_sky(PathParts& parts, const State& path) const;
    void add_emission(PathParts& parts, const State& path, const SurfacePoint& point) const;
    // What the surface sends on of all lights.
    void add_lights(PathParts& parts, const State& path, const SurfacePoint& point) const;
    [[nodiscard]] glm::vec3 of_set(std::size_t set, const State& path, const SurfacePoint& point) const;
    [[nodiscard]] glm::vec3 sent(const bake::Incident& incident, const SurfacePoint& point) const;
    // Whether the path goes on.
    [[nodiscard]] bool scatter(State& path, const SurfacePoint& point) const;

    const PathScene& scene_;
    const trace::Scene& tracing_;
    const glm::vec3 place_;
    const bake::SampleTable& paths_;
    const std::array<std::uint32_t, bake::max_sample_dimensions> shift_;
    std::vector<bake::NextEvent> events_;  // by set of lights
};

}  // namespace drtv::picture
