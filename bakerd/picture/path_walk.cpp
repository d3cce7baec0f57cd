#include "bakerd/picture/path_walk.h"

#include "bakerd/bake/path.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace drtv::picture {

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

PathWalk::PathWalk(const PathScene& scene,
                   const glm::vec3& place,
                   const bake::SampleTable& paths,
                   const glm::ivec3& seed)
    : scene_(scene),
      tracing_(scene.scenery.scene()),
      place_(place),
      paths_(paths),
      shift_(bake::digital_shift(seed)) {
    for (const bake::LightSet& set : scene.scenery.lights().sets())
        events_.emplace_back(tracing_, set, place, scene.settings.reach_m);
}

PathParts PathWalk::radiance(std::uint32_t number, const glm::vec3& direction, float density) const {
    const PathSettings& settings = scene_.settings;
    PathParts parts;
    State path;
    path.number = number;
    path.ray = {place_, direction, settings.reach_m};
    path.density = density;
    for (;; ++path.bounce) {
        const std::optional<trace::Hit> hit = tracing_.closest(path.ray);
        const float end_m = hit ? hit->distance_m : path.ray.far_m;
        path.throughput *= tracing_.passed({path.ray.origin, path.ray.direction, end_m}).tint;
        if (!hit) {
            add_sky(parts, path);
            return parts;
        }
        path.footprint_m += end_m * (path.bounce == 0 ? bake::first_footprint : bake::later_footprint);
        const SurfacePoint point{path.ray,
                                 *hit,
                                 tracing_.surface(*hit, path.footprint_m),
                                 path.ray.origin + path.ray.direction * end_m,
                                 {}};
        if (point.surface.absorbs)
            return parts;
        add_emission(parts, path, point);
        if (path.bounce >= std::max(settings.bounces, settings.local_bounces))
            return parts;
        add_lights(parts, path, point);
        if (!scatter(path, point))
            return parts;
    }
}

void PathWalk::add_sky(PathParts& parts, const State& path) const {
    if (path.ray.direction.z <= 0 || path.bounce > scene_.settings.bounces)
        return;
    glm::vec3& part = path.bounce == 0 ? parts.sky_direct : parts.sky_bounce;
    part += path.throughput * scene_.moment.sky(path.ray.direction, false);
}

void PathWalk::add_emission(PathParts& parts, const State& path, const SurfacePoint& point) const {
    if (point.surface.emission == glm::vec3(0) || path.bounce > scene_.settings.bounces)
        return;
    const std::size_t set = scene_.scenery.lights().set_of(tracing_.object_index(point.hit.instance));
    const float drawn = events_[set].density_of(path.ray.origin, path.ray.direction, point.hit);
    const float share = path.density / (path.density + drawn);
    parts.static_light +=
        path.throughput * point.surface.emission * scene_.factors[set] * (share / bake::lumens_per_watt);
}

void PathWalk::add_lights(PathParts& parts, const State& path, const SurfacePoint& point) const {
    const Moment& moment = scene_.moment;
    if (path.bounce < scene_.settings.bounces) {
        if (const std::optional<Incidence> sun = moment.sun())
            parts.sun_bounce += path.throughput * scattered(tracing_, point, *sun);
        for (std::size_t set = 0; set < events_.size(); ++set)
            parts.static_light += path.throughput * scene_.factors[set] * of_set(set, path, point);
    }
    if (path.bounce < scene_.settings.local_bounces) {
        for (const PointLight& lamp : moment.lamps())
            parts.local += path.throughput * scattered(tracing_, point, incidence(lamp, point.at));
    }
}

glm::vec3 PathWalk::of_set(std::size_t set, const State& path, const SurfacePoint& point) const {
    const bake::NextEvent& event = events_[set];
    glm::vec3 sum(0);
    for (const bake::StaticSun* sun : event.suns())
        sum += sent(event.towards(*sun, point.at), point);
    if (!event.has_drawn_lights())
        return sum;
    const auto incident = event.draw(point.at, light_numbers(path.number, set, path.bounce + 1), {});
    if (!incident)
        return sum;
    glm::vec3 light = sent(*incident, point);
    if (incident->density > 0) {
        const float cosine = glm::dot(incident->direction, point.hit.normal);
        const float through = bake::transmitted_share(point.surface);
        const float of_side = cosine < 0 ? through : 1 - through;
        const float of_path = of_side * std::abs(cosine) * std::numbers::inv_pi_v<float>;
        light *= incident->density / (incident->density + of_path);
    }
    return sum + light;
}

glm::vec3 PathWalk::sent(const bake::Incident& incident, const SurfacePoint& point) const {
    return scattered(tracing_, point, {incident.direction, incident.light, incident.target});
}

bool PathWalk::scatter(State& path, const SurfacePoint& point) const {
    const std::size_t dimension = 2 + 2 * std::size_t{path.bounce};
    const glm::vec2 u = bake::shifted(paths_.point(path.number), shift_, dimension);
    const auto next = bake::scatter(tracing_, path.ray, point.hit, point.surface, u);
    if (!next)
        return false;
    path.throughput *= next->weight;
    path.density = next->density;
    const float far_m = bake::exit_distance(next->origin, next->direction, place_, scene_.settings.reach_m);
    path.ray = {next->origin, next->direction, far_m};
    return true;
}

std::array<double, 3> PathWalk::light_numbers(std::uint32_t path,
                                              std::size_t set,
                                              std::uint32_t point) const {
    std::array<double, 3> u{};
    for (std::uint32_t d = 0; d < u.size(); ++d) {
        const auto number = static_cast<std::uint32_t>(set) * 64 + point * 4 + d;
        u[d] = static_cast<double>(bake::hashed(shift_[0], path, number)) * 0x1p-32;
    }
    return u;
}

}  // namespace drtv::picture
