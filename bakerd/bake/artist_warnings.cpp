#include "bakerd/bake/artist_warnings.h"

#include "bakerd/bake/lights.h"
#include "bakerd/bake/sampling.h"
#include "bakerd/bake/shown_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace drtv::bake {
namespace {

double back_hit_share(const Statistics& statistics) {
    const auto rays = std::max<std::uint64_t>(statistics.rays, 1);
    return static_cast<double>(statistics.back_hits) / static_cast<double>(rays);
}

// Below a lid as wide as the reach some sky is left at the horizon.
bool sees_hardly_any_sky(const Probe& probe) {
    constexpr float hardly_any = 0.1f;
    return std::ranges::all_of(probe.sky_visibility, [](std::int16_t code) {
        return decode_fixed(code, sky_visibility_scale) < hardly_any;
    });
}

bool is_in(const glm::vec3& point, map::SectorCoordinate sector) {
    const glm::vec2 place = glm::floor(glm::vec2(point) / static_cast<float>(map::sector_size_m));
    return place == glm::vec2(sector.i, sector.j);
}

// Directions all around, as even as a lattice makes them (Fibonacci).
glm::vec3 direction_of(std::uint32_t n, std::uint32_t count) {
    constexpr float golden = 0.61803399f;
    const float turn = static_cast<float>(n) * golden;
    return uniform_sphere(
        {(static_cast<float>(n) + 0.5f) / static_cast<float>(count), turn - std::floor(turn)});
}

// The object that keeps all light of the lamp in; nothing where some ray comes farther than that.
std::optional<std::uint32_t> shell_of(const StaticPointLight& lamp, float max_m, const trace::Scene& scene) {
    constexpr std::uint32_t rays = 256;
    std::optional<std::uint32_t> shell;
    for (std::uint32_t n = 0; n < rays; ++n) {
        const glm::vec3 direction = direction_of(n, rays);
        const glm::vec3 end = lamp.position + direction * max_m;
        if (lamp.irradiance_at(end) == glm::vec3(0))
            continue;  // beside the cone
        // Towards the lamp: a surface that it lies on does not keep its light in.
        if (!scene.hides_surface({end, -direction, max_m}))
            return std::nullopt;
        if (shell)
            continue;
        if (const auto hit = scene.closest({lamp.position, direction, max_m}))
            shell = scene.object_index(hit->instance);
    }
    return shell;
}

}  // namespace

bool has_many_back_hits(const Statistics& statistics) {
    constexpr double max_share = 0.05;
    return back_hit_share(statistics) > max_share;
}

void warn_of_back_hits(const map::Map& map,
                       const Sector& sector,
                       std::span<const BackHits> of_probes,
                       std::vector<std::string>& warnings) {
    if (!has_many_back_hits(sector.statistics))
        return;
    std::map<std::uint32_t, std::uint64_t> by_object;
    for (const BackHits& of_probe : of_probes) {
        for (const auto& [object, hits] : of_probe)
            by_object[object] += hits;
    }
    if (by_object.empty())
        return;  // of probes that were given the objects are not known
    const auto most = std::ranges::max_element(by_object, {}, [](const auto& entry) { return entry.second; });
    warnings.push_back(
        fmt::format("sector ({}, {}): {:.0f} % of its rays meet surfaces from behind, most of them those of "
                    "{}: are its faces turned, or is a side of it missing?",
                    sector.i,
                    sector.j,
                    back_hit_share(sector.statistics) * 100,
                    shown_object(map, most->first)));
}

// Without the sector, so that a job says it once.
void warn_of_closed_sky(const trace::Scene& scene,
                        const Sector& sector,
                        std::span<const placement::Position> probes,
                        std::vector<std::string>& warnings) {
    constexpr float far_m = 10;  // beyond what rooms are
    constexpr double nearly_all = 0.9;
    constexpr std::uint32_t directions = 64;
    if (probes.empty() || !std::ranges::all_of(sector.probes, sees_hardly_any_sky))
        return;
    std::size_t rays = 0;
    std::map<std::uint32_t, std::size_t> met;  // rays, by object
    for (const placement::Position& probe : probes) {
        for (std::uint32_t n = 0; n < directions; ++n) {
            const glm::vec3 direction = direction_of(n, directions);
            if (direction.z < 0.25f)
                continue;
            ++rays;
            const auto hit = scene.closest({placement::metres(probe), direction, sector.bake.reach_m});
            if (hit && hit->distance_m >= far_m)
                ++met[scene.object_index(hit->instance)];
        }
    }
    for (const auto& [object, count] : met) {
        if (static_cast<double>(count) < nearly_all * static_cast<double>(rays))
            continue;
        warnings.push_back(
            fmt::format("no probe under {} sees the sky: a dome or lid that stands for the sky is to be "
                        "left out of the bake, with bake_role 'ignore'",
                        shown_object(scene.map(), object)));
    }
}

void warn_of_enclosed_lamps(const trace::Scene& scene,
                            map::SectorCoordinate sector,
                            std::vector<std::string>& warnings) {
    constexpr float near_m = 0.3f;
    for (const map::Light& light : scene.map().lights) {
        if (light.kind == map::LightKind::directional || !shines(light) || !is_in(light.position, sector))
            continue;
        const std::optional<std::uint32_t> shell = shell_of(point_light(light), near_m, scene);
        if (shell)
            warnings.push_back(fmt::format(
                "the light {} at {} is enclosed by {}, and lights nothing "
                "else: move it out, let that glow itself, or leave it out with bake_role 'ignore'",
                shown_name(light.name, "one"),
                shown_place(glm::dvec3(light.position)),
                shown_object(scene.map(), *shell)));
    }
}

}  // namespace drtv::bake
