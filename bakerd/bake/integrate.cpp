// The estimator. First directions are uniform on the sphere; further ones follow the cosine of the surface,
// so that a path's weight is the product of albedos. What a path brings is the sky's SH at the direction in
// which it leaves. Static lights ride on the same paths (static_light.h).
#include "bakerd/bake/integrate.h"

#include "bakerd/bake/path.h"
#include "bakerd/bake/probe_sums.h"
#include "bakerd/bake/static_light.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace drtv::bake {
namespace {

// With fewer, what one path in some hundreds finds is too often not found at all, and its error neither.
constexpr std::uint32_t min_paths = 1024;

class Integrator {
  public:
    Integrator(const ProbeTask& task, const StaticLights& lights) : task_(task), lights_(lights) {
        light_of_set_.assign(lights.sets().size(), no_light);
        for (std::size_t set = 0; set < lights.sets().size(); ++set) {
            StaticLight light(task, lights.sets()[set]);
            if (light.idle())
                continue;
            light_of_set_[set] = static_lights_.size();
            static_lights_.push_back(std::move(light));
        }
    }

    ProbeLight run() {
        const std::uint32_t budget = task_.samples.count();
        const double wanted = static_cast<double>(task_.settings.error);
        run_to(wanted > 0 ? std::min(min_paths, budget) : budget);
        while (wanted > 0 && error() > wanted && 2 * std::uint64_t{light_.paths} <= budget) {
            sums_.pair_blocks();
            for (StaticLight& light : static_lights_)
                light.sums().pair_blocks();
            run_to(2 * light_.paths);
        }
        const double reached = error();
        light_.error = static_cast<float>(reached);
        light_.budget_ended = wanted > 0 && reached > wanted;
        sums_.store(light_);
        store_static_light();
        return std::move(light_);
    }

  private:
    static constexpr std::size_t no_light = SIZE_MAX;

    [[nodiscard]] double error() const {
        double largest = sums_.error().over_mean();
        for (const StaticLight& light : static_lights_)
            largest = std::max(largest, light.sums().error(light_.paths).over_mean());
        return largest;
    }

    void store_static_light() {
        for (std::size_t set = 0; set < light_of_set_.size(); ++set) {
            if (light_of_set_[set] == no_light)
                continue;
            StaticLight& lit = static_lights_[light_of_set_[set]];
            lit.add_direct();
            light_.shadow_rays += lit.shadow_rays();
            StaticLightOfProbe stored = lit.sums().light_of(light_.paths);
            stored.set = set;
            if (set > 0) {
                light_.groups.push_back(stored);
                continue;
            }
            light_.static_irradiance = stored.irradiance;
            light_.static_error = stored.error;
        }
    }

    // Shoots the paths up to `count`, which then make up the blocks.
    void run_to(std::uint32_t count) {
        const auto paths = task_.samples.side_by_side().subspan(light_.paths, count - light_.paths);
        for (const std::uint32_t n : paths) {
            const std::size_t block = std::size_t{n} * block_count / count;
            sums_.choose_block(block);
            for (StaticLight& light : static_lights_)
                light.sums().choose_block(block);
            trace_path(n);
        }
        light_.paths = count;
    }

    [[nodiscard]] Path first_of(std::uint32_t n) const {
        const glm::vec3 direction = uniform_sphere(shifted(task_.samples.point(n), task_.shift, 0));
        Path path;
        path.number = n;
        path.ray = {task_.probe, direction, task_.settings.reach_m};
        path.weights = basis_weights(direction);
        path.half = direction.z > 0 ? Half::upper : Half::lower;
        return path;
    }

    void trace_path(std::uint32_t n) {
        Path path = first_of(n);
        sums_.add_direction(path.weights, path.half);
        for (StaticLight& light : static_lights_)
            light.add_drawn_at_probe(n);
        for (; trace_segment(path); ++path.bounce) {
        }
    }

    // Whether the path goes on.
    bool trace_segment(Path& path) {
        ++light_.rays;
        std::optional<trace::Hit> hit = task_.scene.closest(path.ray);
        watch(path, end_of(path.ray, hit));
        if (!hit)
            hit = doubted(path.ray);
        path.throughput *= tint(path.ray, hit);
        if (!hit) {
            add_sky(path);
            return false;
        }
        const bool last = path.bounce == task_.settings.bounces;
        if (last && static_lights_.empty())
            return false;
        path.footprint_m += hit->distance_m * (path.bounce == 0 ? first_footprint : later_footprint);
        const trace::Surface surface = task_.scene.surface(*hit, path.footprint_m);
        if (surface.absorbs) {
            count_back_hit(task_.scene.object_index(hit->instance));
            return false;
        }
        if (surface.emission != glm::vec3(0))
            add_met(path, *hit, surface.emission);
        if (last)
            return false;
        if (transmitted_share(surface) > 0)
            watch(path, end_of_surface(path.ray, *hit));
        for (StaticLight& light : static_lights_)
            light.add_at_surface(path, *hit, surface);
        return go_on(path, *hit, surface);
    }

    // Emission counts in the object's own set.
    void add_met(const Path& path, const trace::Hit& hit, const glm::vec3& emission) {
        const std::size_t light = light_of_set_[lights_.set_of(task_.scene.object_index(hit.instance))];
        if (light != no_light)
            static_lights_[light].add_met(path, hit, emission);
    }

    bool go_on(Path& path, const trace::Hit& hit, const trace::Surface& surface) {
        const std::size_t dimension = 2 + 2 * std::size_t{path.bounce};
        const glm::vec2 u = shifted(task_.samples.point(path.number), task_.shift, dimension);
        const std::optional<Scattered> next = scatter(task_.scene, path.ray, hit, surface, u);
        if (!next)
            return false;
        path.throughput *= next->weight;
        path.density = next->density;
        const float far_m = exit_distance(next->origin, next->direction, task_.probe, task_.settings.reach_m);
        path.ray = {next->origin, next->direction, far_m};
        return true;
    }

    // What a change on this part of the path could change at most, as a share of the means over the cosines
    // around the basis directions.
    void watch(const Path& path, float length_m) {
        if (task_.watch == nullptr)
            return;
        const float weight = brightest(path.throughput) * 4 / static_cast<float>(task_.samples.count());
        const Shares shares = shares_of(path.weights, weight);
        const bool implied = path.bounce == 0;
        const PathSegment segment{path.ray, length_m, shares, path.number, implied};
        task_.watch->record_segments({&segment, 1});
    }

    // A closed room has no sky at all, not even one ray of it: the first misses are looked at twice. Where
    // these stand, the sky is in sight, and a ray more or less of it is no leak.
    std::optional<trace::Hit> doubted(trace::Ray& ray) {
        constexpr int doubted_misses = 8;
        if (misses_ >= doubted_misses)
            return std::nullopt;
        ++light_.rays;
        const trace::Ray other = trace::beside(ray);
        std::optional<trace::Hit> hit = task_.scene.closest(other);
        if (hit)
            ray = other;
        else
            ++misses_;
        return hit;
    }

    // Of the glass that the ray passed on its way.
    [[nodiscard]] glm::vec3 tint(const trace::Ray& ray, const std::optional<trace::Hit>& hit) const {
        return task_.scene.passed({ray.origin, ray.direction, hit ? hit->distance_m : ray.far_m}).tint;
    }

    void add_sky(const Path& path) {
        if (path.bounce == 0)
            sums_.add_sky(path.weights, path.half, path.throughput);
        else if (path.ray.direction.z > 0)
            sums_.add_bounced_sky(path.weights, path.half, path.throughput, path.ray.direction);
    }

    void count_back_hit(std::uint32_t object) {
        ++light_.back_hits;
        auto& counts = light_.back_hit_objects;
        const auto at =
            std::ranges::lower_bound(counts, object, {}, [](const auto& entry) { return entry.first; });
        if (at != counts.end() && at->first == object)
            ++at->second;
        else
            counts.insert(at, {object, 1});
    }

    const ProbeTask& task_;
    ProbeSums sums_;
    const StaticLights& lights_;
    std::vector<StaticLight> static_lights_;  // of the sets that are not idle
    std::vector<std::size_t> light_of_set_;   // its index in static_lights_, or no_light
    int misses_ = 0;                          // that were looked at twice
    ProbeLight light_;
};

}  // namespace

std::uint32_t sample_dimensions(std::uint32_t bounces, bool with_lights) {
    const std::uint32_t paths = 2 + 2 * bounces;
    if (!with_lights)
        return paths;
    return std::min(paths + numbers_per_light * (bounces + 1), max_sample_dimensions);
}

ProbeLight integrate_probe(const trace::Scene& scene,
                           const StaticLights& lights,
                           const glm::ivec3& position_units,
                           const SampleTable& samples,
                           const IntegrationSettings& settings,
                           RayWatch* watch) {
    const glm::vec3 probe = glm::vec3(position_units) * position_unit_m;
    const ProbeTask task{scene, samples, settings, probe, digital_shift(position_units), watch};
    if (watch != nullptr)
        watch->begin_probe(position_units);
    return Integrator(task, lights).run();
}

}  // namespace drtv::bake
