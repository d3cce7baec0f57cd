#include "bakerd/picture/painter.h"

#include "bakerd/bake/path.h"
#include "bakerd/bake/sampling.h"
#include "bakerd/map/colour.h"
#include "bakerd/picture/probe_mix.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace drtv::picture {
namespace {

// What shows shapes under colours that say something else.
float shape_of(const SurfacePoint& point) {
    const glm::vec3 from = glm::normalize(glm::vec3(-0.4f, -0.5f, 0.8f));
    return 0.45f + 0.55f * std::max(0.0f, glm::dot(point.hit.normal, from));
}

glm::vec3 colour_of(const ProbeShare& probe) {
    if (probe.sector == nullptr)
        return glm::vec3(0.05f);
    const auto i = static_cast<std::uint32_t>(probe.sector->view.i);
    const auto j = static_cast<std::uint32_t>(probe.sector->view.j);
    glm::vec3 colour;
    for (glm::length_t c = 0; c < 3; ++c)
        colour[c] = 0.1f + 0.8f * bake::unit_float(
                                      bake::hashed(i * 7919 + j, probe.probe, static_cast<std::uint32_t>(c)));
    return colour;
}

// As drtv_view_weights of the shaders.
glm::vec3 weights_colour(RelightMode mode, const glm::vec3& normal) {
    const Float4 w = basis_weights(mode, as_float3(normal));
    const glm::vec3 up = glm::max(glm::vec3(w[0], w[1], w[2]), glm::vec3(0));
    return glm::min(up + 0.4f * std::max(w[3], 0.0f), glm::vec3(1));
}

}  // namespace

glm::vec3 part_of(const Ambient& ambient, Show show) {
    switch (show) {
        case Show::sky_direct:  // what stands in where no probe is known is of the sky alone
            return as_vec(ambient.parts.sky_direct) + as_vec(ambient.parts.fallback);
        case Show::sky_bounce:
            return as_vec(ambient.parts.sky_bounce);
        case Show::sun_bounce:
            return as_vec(ambient.parts.sun_bounce);
        case Show::static_light:
            return as_vec(ambient.parts.static_light);
        case Show::local:
            return as_vec(ambient.parts.local);
        default:
            return as_vec(ambient.colour);
    }
}

glm::vec3 direct_light(const Scenery& scenery, const Moment& moment, const SurfacePoint& point) {
    const trace::Scene& scene = scenery.scene();
    glm::vec3 light(0);
    if (const std::optional<Incidence> sun = moment.sun())
        light += scattered(scene, point, *sun);
    for (const PointLight& lamp : moment.lamps())
        light += scattered(scene, point, incidence(lamp, point.at));
    if (point.surface.emission != glm::vec3(0)) {
        const bake::StaticLights& lights = scenery.lights();
        const std::size_t set = lights.set_of(scene.object_index(point.hit.instance));
        light += point.surface.emission / bake::lumens_per_watt * moment.factor_of(lights.sets()[set].name);
    }
    return light;
}

glm::vec3 sky_seen(const Scenery& scenery, const Moment& moment, const trace::Ray& ray, bool with_sun) {
    return scenery.scene().passed(ray).tint * moment.sky(ray.direction, with_sun);
}

Painter::Painter(const Scenery& scenery, const Moment& moment, const Camera& camera, Show show)
    : scenery_(scenery), moment_(moment), camera_(camera), show_(show) {
    if (show == Show::probes)
        spheres_.emplace(moment, camera);
}

glm::vec3 Painter::colour(glm::vec2 pixel) const {
    const trace::Ray ray = camera_.ray(pixel);
    const std::optional<SurfacePoint> point = surface_on(scenery_.scene(), camera_, ray);
    if (show_ == Show::probes)
        return with_spheres(ray, point, pixel);
    if (!point)
        return show_ == Show::all ? sky_seen(scenery_, moment_, ray, true) : glm::vec3(0);
    if (show_ == Show::all)
        return whole(*point);
    if (show_ == Show::ambient)
        return moment_.ambient_colour(point->at, point->hit.normal);
    if (picture::is_light(show_))
        return part_of(moment_.ambient(point->at, point->hit.normal), show_);
    return of_runtime(*point);
}

float Painter::brightness_of(const SurfacePoint& point) const {
    constexpr float least = 0.02f;
    const float albedo = map::luminance(point.surface.albedo + point.surface.transmitted);
    return show_ == Show::all ? std::max(albedo, least) : 1;
}

glm::vec3 Painter::whole(const SurfacePoint& point) const {
    if (point.surface.absorbs)
        return glm::vec3(0);
    const glm::vec3& normal = point.hit.normal;
    glm::vec3 light = point.surface.albedo * moment_.ambient_colour(point.at, normal);
    if (point.surface.transmitted != glm::vec3(0))
        light += point.surface.transmitted * moment_.ambient_colour(point.at, -normal);
    return point.tint * (light + direct_light(scenery_, moment_, point));
}

glm::vec3 Painter::with_spheres(const trace::Ray& ray,
                                const std::optional<SurfacePoint>& point,
                                glm::vec2 pixel) const {
    constexpr float dimmed = 0.3f;
    const auto sphere = spheres_->first_on(ray, pixel);
    if (sphere && (!point || sphere->distance_m < point->hit.distance_m))
        return sphere->radiance;
    return dimmed * (point ? whole(*point) : sky_seen(scenery_, moment_, ray, false));
}

glm::vec3 Painter::of_runtime(const SurfacePoint& point) const {
    const glm::vec3& normal = point.hit.normal;
    const SectorSet& set = moment_.set();
    const Double3 asked = as_place(asked_place(point.at, normal));
    switch (show_) {
        case Show::fallback:
            return shape_of(point) * fallback(point);
        case Show::tile:
            return glm::vec3(set.sky_factor(asked));
        case Show::cells:
            return shape_of(point) * colour_of(set.nearest(asked).probes[0]);
        case Show::leaks:
            return leaks(point);
        case Show::weights:
            return weights_colour(moment_.light().mode, normal);
        case Show::age: {
            const auto frames = static_cast<float>(age_->frames_at(asked_place(point.at, normal)));
            const float fresh = 1 - frames / TexelAge::frames;
            return glm::vec3(fresh, fresh * fresh, fresh * fresh);
        }
        default:
            return clipped(point);
    }
}

// Red where the distance lights, green where probes do, blue by what the distance has lost to its tile.
glm::vec3 Painter::fallback(const SurfacePoint& point) const {
    const float distance = mix_at(moment_, point.at, point.hit.normal).fallback;
    const float open = moment_.set().sky_factor(as_place(asked_place(point.at, point.hit.normal)));
    return {distance, 1 - distance, distance * (1 - open)};
}

// Red by the share of probes from which something static separates the surface.
glm::vec3 Painter::leaks(const SurfacePoint& point) const {
    const std::optional<glm::vec3> start = bake::before_surface(point.ray, point.hit);
    if (!start)
        return glm::vec3(0);
    const ProbeMix mix = mix_at(moment_, point.at, point.hit.normal);
    float leak = 0;
    for (std::size_t n = 0; n < mix.count; ++n) {
        const ProbeShare& probe = mix.probes[n];
        const glm::vec3 way = as_vec(position_m(probe.sector->view, probe.probe)) - *start;
        const float length_m = glm::length(way);
        if (length_m > 0 && scenery_.scene().separated({*start, way / length_m, length_m}))
            leak += probe.share;
    }
    return shape_of(point) * glm::mix(glm::vec3(0.5f), glm::vec3(1, 0, 0), leak);
}

// As drtv_view_clipped of the shaders: red where a texel is at its encoding's end, blue where it holds a 0;
// nothing outside of the volume.
glm::vec3 Painter::clipped(const SurfacePoint& point) const {
    const Volume& volume = *moment_.volume();
    Double3 middle = as_place(asked_place(point.at, point.hit.normal));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double width = double{volume.settings().texel_m[axis]};
        middle[axis] = (std::floor(middle[axis] / width) + 0.5) * width;
    }
    const Volume::Sample sample = volume.sample(middle);
    if (!(sample.weight > 0))
        return glm::vec3(0);
    glm::vec3 most(0);
    glm::vec3 least(INFINITY);
    for (const Float3& colour : sample.colours) {
        most = glm::max(most, as_vec(colour));
        least = glm::min(least, as_vec(colour));
    }
    const bool is_half = volume.settings().encoding == TexelEncoding::rgba16f;
    if (map::brightest(most) >= 0.9995f * (is_half ? 65504.0f : volume.scale()))
        return {1, 0, 0};
    if (std::min({least.x, least.y, least.z}) <= 0.00001f * volume.scale())
        return {0, 0, 1};
    return glm::vec3(std::min(1.0f, (most.x + most.y + most.z) / (3 * volume.scale())));
}

}  // namespace drtv::picture
