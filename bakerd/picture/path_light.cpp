#include "bakerd/picture/path_light.h"

#include "bakerd/picture/surface_point.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace drtv::picture {
namespace {

constexpr float inv_pi = std::numbers::inv_pi_v<float>;

}  // namespace

void PathParts::add(const PathParts& parts, const glm::vec3& weight) {
    sky_direct += parts.sky_direct * weight;
    sky_bounce += parts.sky_bounce * weight;
    sun_bounce += parts.sun_bounce * weight;
    static_light += parts.static_light * weight;
    local += parts.local * weight;
}

glm::vec3 part_of(const PathParts& truth, Show show) {
    switch (show) {
        case Show::sky_direct:
            return truth.sky_direct;
        case Show::sky_bounce:
            return truth.sky_bounce;
        case Show::sun_bounce:
            return truth.sun_bounce;
        case Show::static_light:
            return truth.static_light;
        case Show::local:
            return truth.local;
        default:
            return truth.total();
    }
}

// The paths of one place.
class PathLight::Walk {
  public:
    Walk(const PathLight& light,
         const glm::vec3& place,
         const bake::SampleTable& paths,
         const glm::ivec3& seed)
        : light_(light),
          scene_(light.scenery_.scene()),
          settings_(light.settings_),
          place_(place),
          paths_(paths),
          shift_(bake::digital_shift(seed)) {
        for (const bake::LightSet& set : light.scenery_.lights().sets())
            events_.emplace_back(scene_, set, place, settings_.reach_m);
    }

    [[nodiscard]] glm::vec2 first_numbers(std::uint32_t path) const {
        return bake::shifted(paths_.point(path), shift_, 0);
    }

    // What comes along one direction, which is drawn with that density.
    [[nodiscard]] PathParts radiance(std::uint32_t path, const glm::vec3& direction, float density) {
        path_ = path;
        density_ = density;
        PathParts parts;
        trace::Ray ray{place_, direction, settings_.reach_m};
        glm::vec3 throughput(1);
        float footprint_m = 0;
        for (std::uint32_t bounce = 0;; ++bounce) {
            const std::optional<trace::Hit> hit = scene_.closest(ray);
            throughput *= scene_.passed({ray.origin, ray.direction, hit ? hit->distance_m : ray.far_m}).tint;
            if (!hit) {
                if (ray.direction.z > 0 && bounce <= settings_.bounces)
                    (bounce == 0 ? parts.sky_direct : parts.sky_bounce) +=
                        throughput * light_.moment_.sky(ray.direction, false);
                return parts;
            }
            footprint_m += hit->distance_m * (bounce == 0 ? bake::first_footprint : bake::later_footprint);
            const trace::Surface surface = scene_.surface(*hit, footprint_m);
            if (surface.absorbs)
                return parts;
            if (bounce <= settings_.bounces)
                add_emission(parts, ray, *hit, surface, throughput);
            if (bounce >= std::max(settings_.bounces, settings_.local_bounces))
                return parts;
            add_lights(parts, ray, *hit, surface, throughput, bounce);
            const auto next =
                bake::scatter(scene_,
                              ray,
                              *hit,
                              surface,
                              bake::shifted(paths_.point(path_), shift_, 2 + 2 * std::size_t{bounce}));
            if (!next)
                return parts;
            throughput *= next->weight;
            density_ = next->density;
            ray = {next->origin,
                   next->direction,
                   bake::exit_distance(next->origin, next->direction, place_, settings_.reach_m)};
        }
    }

    // Of lamps and suns of the map, straight to the place: `weight` says how much a direction counts.
    template <class Weight>
    [[nodiscard]] glm::vec3 direct(const Weight& weight) const {
        glm::vec3 sum(0);
        for (std::size_t set = 0; set < events_.size(); ++set) {
            const bake::NextEvent& event = events_[set];
            for (const bake::Sun* sun : event.suns())
                sum += seen(event.towards(*sun, place_), weight) * light_.factors_[set];
            for (const bake::PointLight* lamp : event.points())
                sum += seen(event.towards(*lamp, place_), weight) * light_.factors_[set];
        }
        return sum;
    }

    // Of glowing surfaces, drawn at the place beside the path's own direction, which has that density by
    // direction.
    template <class Weight, class Density>
    [[nodiscard]] glm::vec3 drawn(std::uint32_t path, const Weight& weight, const Density& density) {
        path_ = path;
        glm::vec3 sum(0);
        for (std::size_t set = 0; set < events_.size(); ++set) {
            if (!events_[set].has_emissive())
                continue;
            const auto incident = events_[set].draw(place_, light_numbers(set, 0), {});
            if (!incident || !(incident->density > 0))
                continue;
            const float share = incident->density / (incident->density + density(incident->direction));
            sum += seen(*incident, weight) * light_.factors_[set] * share;
        }
        return sum;
    }

  private:
    template <class Weight>
    [[nodiscard]] glm::vec3 seen(const bake::Incident& incident, const Weight& weight) const {
        const float counts = weight(incident.direction);
        if (!(counts > 0) || incident.light == glm::vec3(0))
            return glm::vec3(0);
        return incident.light * (counts * inv_pi) * shadow(place_, incident);
    }

    [[nodiscard]] glm::vec3 shadow(const glm::vec3& from, const bake::Incident& incident) const {
        return scene_.share_seen(bake::NextEvent::shadow_ray(from, incident), incident.target.has_value());
    }

    [[nodiscard]] std::array<double, 3> light_numbers(std::size_t set, std::uint32_t point) const {
        std::array<double, 3> u{};
        for (std::uint32_t d = 0; d < u.size(); ++d) {
            const auto number = static_cast<std::uint32_t>(set) * 64 + point * 4 + d;
            u[d] = static_cast<double>(bake::hashed(shift_[0], path_, number)) * 0x1p-32;
        }
        return u;
    }

    void add_emission(PathParts& parts,
                      const trace::Ray& ray,
                      const trace::Hit& hit,
                      const trace::Surface& surface,
                      const glm::vec3& throughput) const {
        if (surface.emission == glm::vec3(0))
            return;
        const std::size_t set = light_.scenery_.lights().set_of(scene_.object_index(hit.instance));
        const float drawn = events_[set].density_of(ray.origin, ray.direction, hit);
        const float share = density_ / (density_ + drawn);
        parts.static_light +=
            throughput * surface.emission * light_.factors_[set] * (share / bake::lumens_per_watt);
    }

    // What the surface sends on of all lights.
    void add_lights(PathParts& parts,
                    const trace::Ray& ray,
                    const trace::Hit& hit,
                    const trace::Surface& surface,
                    const glm::vec3& throughput,
                    std::uint32_t bounce) const {
        const glm::vec3 at = ray.origin + ray.direction * hit.distance_m;
        const SurfacePoint point{ray, hit, surface, at, glm::vec3(1)};
        if (bounce < settings_.bounces) {
            const Sun& sun = light_.moment_.light().sun;
            if (sun.direction[2] > 0)
                parts.sun_bounce +=
                    throughput *
                    scattered(scene_,
                              point,
                              {glm::normalize(as_vec(sun.direction)), as_vec(sun.irradiance), std::nullopt});
            for (std::size_t set = 0; set < events_.size(); ++set)
                parts.static_light += throughput * light_.factors_[set] * of_set(set, point, bounce + 1);
        }
        if (bounce < settings_.local_bounces) {
            for (const PointLight& lamp : light_.moment_.lamps()) {
                const glm::vec3 place(lamp.position[0], lamp.position[1], lamp.position[2]);
                parts.local +=
                    throughput * scattered(scene_, point, incidence(place, as_vec(lamp.intensity), at));
            }
        }
    }

    [[nodiscard]] glm::vec3 of_set(std::size_t set, const SurfacePoint& point, std::uint32_t number) const {
        const bake::NextEvent& event = events_[set];
        glm::vec3 sum(0);
        for (const bake::Sun* sun : event.suns())
            sum += sent(event.towards(*sun, point.at), point);
        if (!event.has_drawn_lights())
            return sum;
        const auto incident = event.draw(point.at, light_numbers(set, number), {});
        if (!incident)
            return sum;
        glm::vec3 light = sent(*incident, point);
        if (incident->density > 0) {
            const float cosine = glm::dot(incident->direction, point.hit.normal);
            const float through = bake::transmitted_share(point.surface);
            const float side = cosine < 0 ? through : 1 - through;
            light *= incident->density / (incident->density + side * std::abs(cosine) * inv_pi);
        }
        return sum + light;
    }

    [[nodiscard]] glm::vec3 sent(const bake::Incident& incident, const SurfacePoint& point) const {
        return scattered(scene_, point, {incident.direction, incident.light, incident.target});
    }

    const PathLight& light_;
    const trace::Scene& scene_;
    const PathSettings& settings_;
    const glm::vec3 place_;
    const bake::SampleTable& paths_;
    const std::array<std::uint32_t, bake::max_sample_dimensions> shift_;
    std::vector<bake::NextEvent> events_;  // by set of lights
    std::uint32_t path_ = 0;
    float density_ = 0;  // of the path's last direction
};

PathLight::PathLight(const Scenery& scenery, const Moment& moment, const PathSettings& settings)
    : scenery_(scenery), moment_(moment), settings_(settings) {
    for (const bake::LightSet& set : scenery.lights().sets())
        factors_.push_back(moment.factor_of(set.name));
}

std::uint32_t PathLight::dimensions() const {
    return 2 + 2 * std::max(settings_.bounces, settings_.local_bounces);
}

PathParts PathLight::at_normal(const glm::vec3& place,
                               const glm::vec3& normal,
                               const bake::SampleTable& paths,
                               const glm::ivec3& seed) const {
    Walk walk(*this, place, paths, seed);
    PathParts sum;
    const auto cosine = [&](const glm::vec3& w) { return glm::dot(normal, w); };
    const glm::vec3 share(1 / static_cast<float>(paths.count()));
    for (std::uint32_t path = 0; path < paths.count(); ++path) {
        const glm::vec3 w = bake::cosine_hemisphere(walk.first_numbers(path), normal);
        const float density = std::max(cosine(w), 0.0f) * inv_pi;
        if (!(density > 0))
            continue;
        sum.add(walk.radiance(path, w, density), share);
        sum.static_light += share * walk.drawn(path, cosine, [&](const glm::vec3& other) {
            return std::max(cosine(other), 0.0f) * inv_pi;
        });
    }
    sum.static_light += walk.direct(cosine);
    return sum;
}

PathBasis PathLight::at_basis(const glm::vec3& place,
                              const bake::SampleTable& paths,
                              const glm::ivec3& seed) const {
    Walk walk(*this, place, paths, seed);
    PathBasis sum{};
    constexpr float uniform = inv_pi / 4;
    const float share = 1 / static_cast<float>(paths.count());
    const auto cosine_to = [](std::size_t b) {
        return [n = as_vec(transfer_basis[b])](const glm::vec3& w) { return glm::dot(n, w); };
    };
    for (std::uint32_t path = 0; path < paths.count(); ++path) {
        const glm::vec3 w = bake::uniform_sphere(walk.first_numbers(path));
        const PathParts radiance = walk.radiance(path, w, uniform);
        for (std::size_t b = 0; b < basis_count; ++b) {
            const auto cosine = cosine_to(b);
            if (cosine(w) > 0)
                sum[b].add(radiance, glm::vec3(4 * share * cosine(w)));
            sum[b].static_light += share * walk.drawn(path, cosine, [](const glm::vec3&) { return uniform; });
        }
    }
    for (std::size_t b = 0; b < basis_count; ++b)
        sum[b].static_light += walk.direct(cosine_to(b));
    return sum;
}

}  // namespace drtv::picture
