// The estimator. First directions are uniform on the sphere; further ones follow the cosine of the surface,
// so that a path's weight is the product of albedos. What a path brings is the sky's SH at the direction in
// which it leaves. Upper and lower half of the first directions are normalised apart, each by the sum of its
// own basis cosines over the same samples: an open sky, a plane and the energy bound then hold exactly,
// whatever the samples. Static lights ride on the same paths: at each of their points one light is drawn, and
// emissive surfaces count both when they are drawn and when a path meets them, by the balance heuristic
// (Veach 1997).
#include "bakerd/bake/integrate.h"

#include "bakerd/bake/convergence.h"
#include "bakerd/bake/next_event.h"
#include "bakerd/bake/path.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace drtv::bake {
namespace {

using Accumulator = std::array<std::array<std::array<double, sh_count>, basis_count>, channel_count>;
using BasisWeights = std::array<float, basis_count>;
using BasisSums = std::array<std::array<double, basis_count>, channel_count>;

enum Half : std::size_t { upper, lower };

// Of the first directions, per steradian.
constexpr float uniform_density = 0.25f * std::numbers::inv_pi_v<float>;

BasisWeights basis_weights(const glm::vec3& w) {
    BasisWeights weights{};
    for (std::size_t b = 0; b < basis_count; ++b) {
        weights[b] = std::max(
            0.0f, w.x * transfer_basis[b][0] + w.y * transfer_basis[b][1] + w.z * transfer_basis[b][2]);
    }
    return weights;
}

// The share of a cosine lobe around the basis direction that lies above the horizon.
double upper_share(std::size_t b) {
    return (1 + static_cast<double>(transfer_basis[b][2])) / 2;
}

void add(BasisSums& sums, const BasisWeights& weights, const glm::vec3& light) {
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b)
            sums[c][b] += static_cast<double>(weights[b] * light[static_cast<glm::length_t>(c)]);
    }
}

void add(BasisSums& sums, const BasisSums& more) {
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t b = 0; b < basis_count; ++b)
            sums[c][b] += more[c][b];
    }
}

// Sums over one block of samples, enough for its relit irradiance.
struct Block {
    std::array<std::array<double, basis_count>, 2> weights{};  // by half of the first direction
    std::array<BasisSums, 2> lit{};                            // under a sky of radiance 1
    BasisSums static_light{};

    void add(const Block& other) {
        for (std::size_t half : {upper, lower}) {
            for (std::size_t b = 0; b < basis_count; ++b)
                weights[half][b] += other.weights[half][b];
            bake::add(lit[half], other.lit[half]);
        }
        bake::add(static_light, other.static_light);
    }
};

constexpr std::uint32_t numbers_a_light = 3;

// With fewer, what one path in some hundreds finds is too often not found at all, and its error neither.
constexpr std::uint32_t least_paths = 1024;

// What adds less than this to a path's static light, W/m2, is looked at only so often, and then counts as
// this much: in the mean of some 1,000 paths it does not show. So lamps far away cost nothing.
constexpr float faint = 0.01f;

class Integrator {
  public:
    Integrator(const trace::Scene& scene,
               const StaticLights& lights,
               const glm::ivec3& position_units,
               const SampleTable& samples,
               const IntegrationSettings& settings,
               const RayWatch& watch)
        : scene_(scene),
          samples_(samples),
          settings_(settings),
          watch_(watch),
          probe_(glm::vec3(position_units) * position_unit_m),
          shift_(digital_shift(position_units)),
          next_event_(scene, lights, probe_, settings.reach_m),
          lit_(!next_event_.idle()) {}

    ProbeLight run() {
        if (settings_.error > 0) {
            run_to(std::min(least_paths, samples_.count()));
            while (reached_error() > static_cast<double>(settings_.error) &&
                   2 * std::uint64_t{light_.paths} <= samples_.count()) {
                for (std::size_t k = 0; k < block_count / 2; ++k) {
                    Block pair = blocks_[2 * k];
                    pair.add(blocks_[2 * k + 1]);
                    blocks_[k] = pair;
                }
                std::fill(blocks_.begin() + block_count / 2, blocks_.end(), Block{});
                run_to(2 * light_.paths);
            }
        } else {
            run_to(samples_.count());
        }
        light_.error = static_cast<float>(reached_error());
        if (lit_)
            add_direct_light();
        return normalised();
    }

  private:
    // Shoots the paths up to `count`, which then make up the blocks.
    void run_to(std::uint32_t count) {
        for (const std::uint32_t n : samples_.side_by_side().subspan(light_.paths, count - light_.paths)) {
            block_ = &blocks_[std::size_t{n} * block_count / count];
            trace_path(n);
        }
        light_.paths = count;
    }

    // Numbers that draw a light at a path's k-th point: of the table as far as it goes, else hashed.
    [[nodiscard]] std::array<double, numbers_a_light> light_sample(std::uint32_t n, std::uint32_t k) const {
        std::array<double, numbers_a_light> u{};
        const std::span<const std::uint32_t> point = samples_.point(n);
        for (std::size_t d = 0; d < numbers_a_light; ++d) {
            const std::size_t dimension =
                2 + 2 * std::size_t{settings_.bounces} + numbers_a_light * std::size_t{k} + d;
            const std::uint32_t word = dimension < point.size()
                                           ? point[dimension] ^ shift_[dimension]
                                           : hashed(shift_[0], n, static_cast<std::uint32_t>(dimension));
            u[d] = static_cast<double>(word) * 0x1p-32;
        }
        return u;
    }

    void trace_path(std::uint32_t n) {
        const std::span<const std::uint32_t> point = samples_.point(n);
        trace::Ray ray{probe_, uniform_sphere(shifted(point, shift_, 0)), settings_.reach_m};
        const BasisWeights weights = basis_weights(ray.direction);
        const Half half = ray.direction.z > 0 ? upper : lower;
        for (std::size_t b = 0; b < basis_count; ++b)
            block_->weights[half][b] += static_cast<double>(weights[b]);
        add_emission_drawn_at_probe(n);

        glm::vec3 throughput(1);
        float density = uniform_density, footprint_m = 0;
        for (std::uint32_t bounce = 0;; ++bounce) {
            ++light_.rays;
            if (watch_.log != nullptr)
                watch_.log->paths.push_back(ray);
            std::optional<trace::Hit> hit = scene_.closest(ray);
            note_path(ray, hit ? hit->distance_m : ray.far_m, weights, throughput, n, bounce);
            if (!hit)
                hit = doubted(ray);
            if (!hit) {
                if (bounce == 0)
                    add_sky(weights, half);
                else if (ray.direction.z > 0)
                    add_bounce(weights, half, throughput, ray.direction);
                return;
            }
            if (bounce == settings_.bounces && !lit_)
                return;
            footprint_m += hit->distance_m * (bounce == 0 ? first_footprint : later_footprint);
            const trace::Surface surface = scene_.surface(*hit, footprint_m);
            if (surface.absorbs) {
                count_back_hit(scene_.object_index(hit->instance));
                return;
            }
            if (lit_ && surface.emission != glm::vec3(0))
                add_emission_met(ray, *hit, surface.emission, density, weights, throughput);
            if (bounce == settings_.bounces)
                return;
            if (transmitted_share(surface) > 0)
                note_path(ray, end_of_beyond_surface(ray, *hit), weights, throughput, n, bounce);
            if (lit_)
                add_light_at(ray, *hit, surface, n, bounce + 1, weights, throughput);
            const std::optional<Scattered> next =
                scatter(scene_, ray, *hit, surface, shifted(point, shift_, 2 + 2 * std::size_t{bounce}));
            if (!next)
                return;
            throughput *= next->weight;
            density = next->density;
            ray = {next->origin,
                   next->direction,
                   exit_distance(next->origin, next->direction, probe_, settings_.reach_m)};
        }
    }

    // What a change on this part of the path could change at most, as a share of the means over the cosines
    // around the basis directions.
    void note_path(const trace::Ray& ray,
                   float length_m,
                   const BasisWeights& weights,
                   const glm::vec3& throughput,
                   std::uint32_t n,
                   std::uint32_t bounce) {
        if (watch_.footprint == nullptr || bounce == 0)
            return;
        watch_.footprint->path(
            ray,
            length_m,
            scaled(weights, brightest(throughput) * 4 / static_cast<float>(samples_.count())),
            n);
    }

    static Shares scaled(const BasisWeights& weights, float by) {
        return {weights[0] * by, weights[1] * by, weights[2] * by, weights[3] * by};
    }

    // A closed room has no sky at all, not even one ray of it: the first misses are looked at twice. Where
    // these stand, the sky is in sight, and a ray more or less of it is no leak.
    std::optional<trace::Hit> doubted(trace::Ray& ray) {
        constexpr int doubted_misses = 8;
        if (misses_ >= doubted_misses)
            return std::nullopt;
        ++light_.rays;
        const trace::Ray other = trace::beside(ray);
        std::optional<trace::Hit> hit = scene_.closest(other);
        if (hit)
            ray = other;
        else
            ++misses_;
        return hit;
    }

    void count_back_hit(std::uint32_t object) {
        ++light_.back_hits;
        const auto at = std::ranges::lower_bound(
            light_.back_hit_objects, object, {}, &std::pair<std::uint32_t, std::uint32_t>::first);
        if (at != light_.back_hit_objects.end() && at->first == object)
            ++at->second;
        else
            light_.back_hit_objects.insert(at, {object, 1});
    }

    void add_sky(const BasisWeights& weights, Half half) {
        if (half == lower)
            return;
        for (std::size_t b = 0; b < basis_count; ++b)
            visible_sum_[b] += static_cast<double>(weights[b]);
        add(block_->lit[upper], weights, glm::vec3(1));
    }

    void add_bounce(const BasisWeights& weights,
                    Half half,
                    const glm::vec3& throughput,
                    const glm::vec3& out) {
        const Float4 y = evaluate_sh({out.x, out.y, out.z});
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t b = 0; b < basis_count; ++b) {
                const double radiance =
                    static_cast<double>(weights[b] * throughput[static_cast<glm::length_t>(c)]);
                for (std::size_t i = 0; i < sh_count; ++i)
                    bounce_sum_[half][c][b][i] += radiance * static_cast<double>(y[i]);
            }
        }
        add(block_->lit[half], weights, throughput);
    }

    // Radiance that a path met on an emissive surface. The first directions' density cancels with `weights`'
    // own, which all sums share: they count radiance times cosine times 4.
    void add_emission_met(const trace::Ray& ray,
                          const trace::Hit& hit,
                          const glm::vec3& emission,
                          float density,
                          const BasisWeights& weights,
                          const glm::vec3& throughput) {
        const float drawn = next_event_.density_of(ray.origin, ray.direction, hit);
        add(block_->static_light,
            weights,
            throughput * emission * (4 * density / (lumens_per_watt * (density + drawn))));
    }

    // Punctual lights are summed up without noise in the end; emissive surfaces are drawn here.
    void add_emission_drawn_at_probe(std::uint32_t n) {
        if (!next_event_.has_emissive())
            return;
        const std::optional<Incident> incident = next_event_.draw(probe_, light_sample(n, 0), {0, 0});
        if (!incident || incident->density <= 0)
            return;
        glm::vec3 light = incident->light * (incident->density / (incident->density + uniform_density) *
                                             std::numbers::inv_pi_v<float>);
        const float paths = static_cast<float>(samples_.count());
        if (!survives(light, n, 0) ||
            !sees(probe_, *incident, basis_weights(incident->direction), light / paths))
            return;
        add(block_->static_light, basis_weights(incident->direction), light);
    }

    // Light from a static light by way of the surface that was hit: the path's k-th point.
    void add_light_at(const trace::Ray& ray,
                      const trace::Hit& hit,
                      const trace::Surface& surface,
                      std::uint32_t n,
                      std::uint32_t k,
                      const BasisWeights& weights,
                      const glm::vec3& throughput) {
        const glm::vec3 point = ray.origin + ray.direction * hit.distance_m;
        const auto add_incident = [&](const Incident& incident) {
            const float cosine = glm::dot(incident.direction, hit.normal);
            const bool through = cosine < 0;
            const glm::vec3& share = through ? surface.transmitted : surface.albedo;
            glm::vec3 light =
                throughput * share * incident.light * (std::abs(cosine) * 4 * std::numbers::inv_pi_v<float>);
            if (!survives(light, n, 2 * k + 1))
                return;
            const std::optional<glm::vec3> start =
                through ? beyond_surface(scene_, ray, hit) : before_surface(ray, hit);
            if (!start || !sees(*start, incident, weights, light / static_cast<float>(samples_.count())))
                return;
            if (incident.density > 0) {
                const float side = transmitted_share(surface);
                const float density =
                    (through ? side : 1 - side) * std::abs(cosine) * std::numbers::inv_pi_v<float>;
                light *= incident.density / (incident.density + density);
            }
            add(block_->static_light, weights, light);
        };
        for (const Sun& sun : next_event_.suns())
            add_incident(next_event_.towards(sun, point));
        if (!next_event_.has_drawn_lights())
            return;
        const float most = brightest(throughput * (surface.albedo + surface.transmitted)) *
                           (4 * std::numbers::inv_pi_v<float>);
        const Roulette roulette{static_cast<float>(hashed(shift_[1], n, 2 * k)) * 0x1p-32f, faint / most};
        if (const std::optional<Incident> incident = next_event_.draw(point, light_sample(n, k), roulette))
            add_incident(*incident);
    }

    // Russian roulette: faint light is dropped, or raised by as much as it is seldom kept.
    [[nodiscard]] bool survives(glm::vec3& light, std::uint32_t n, std::uint32_t number) const {
        const float most = brightest(light);
        if (most >= faint)
            return true;
        if (static_cast<float>(hashed(shift_[1], n, number)) * 0x1p-32f * faint >= most)
            return false;
        light *= faint / most;
        return true;
    }

    static float brightest(const glm::vec3& light) { return std::max({light.x, light.y, light.z}); }

    // `light` times `weights` is what the answer brings to the static irradiance.
    bool sees(const glm::vec3& start,
              const Incident& incident,
              const BasisWeights& weights,
              const glm::vec3& light) {
        ++light_.shadow_rays;
        const trace::Ray ray = NextEvent::shadow_ray(start, incident);
        if (watch_.log != nullptr)
            watch_.log->shadows.push_back(ray);
        if (watch_.footprint != nullptr)
            watch_.footprint->lone(ray, scaled(weights, brightest(light) / static_irradiance_range));
        return !scene_.occluded(ray);
    }

    void add_direct_light() {
        const auto add_incident = [&](const Incident& incident) {
            const BasisWeights weights = basis_weights(incident.direction);
            const glm::vec3 light = incident.light * std::numbers::inv_pi_v<float>;
            if (incident.light != glm::vec3(0) && sees(probe_, incident, weights, light))
                add(direct_, weights, light);
        };
        for (const Sun& sun : next_event_.suns())
            add_incident(next_event_.towards(sun, probe_));
        for (const PointLight* light : next_event_.points())
            add_incident(next_event_.towards(*light, probe_));
    }

    [[nodiscard]] double reached_error() const {
        BlockMeans relit{}, lit{};
        for (std::size_t k = 0; k < block_count; ++k) {
            const double paths = static_cast<double>(light_.paths) / block_count;
            for (std::size_t c = 0; c < channel_count; ++c) {
                for (std::size_t b = 0; b < basis_count; ++b) {
                    for (std::size_t half : {upper, lower}) {
                        const double share = half == upper ? upper_share(b) : 1 - upper_share(b);
                        if (blocks_[k].weights[half][b] > 0)
                            relit[k][c][b] +=
                                share * blocks_[k].lit[half][c][b] / blocks_[k].weights[half][b];
                    }
                    lit[k][c][b] = blocks_[k].static_light[c][b] / paths;
                }
            }
        }
        return lit_ ? std::max(relative_error(relit), relative_error(lit)) : relative_error(relit);
    }

    ProbeLight normalised() {
        Block all;
        for (const Block& block : blocks_)
            all.add(block);
        for (std::size_t b = 0; b < basis_count; ++b) {
            const std::array<double, 2> share = {upper_share(b), 1 - upper_share(b)};
            for (std::size_t half : {upper, lower}) {
                if (all.weights[half][b] <= 0)
                    continue;
                const double scale = share[half] / all.weights[half][b];
                for (std::size_t c = 0; c < channel_count; ++c) {
                    for (std::size_t i = 0; i < sh_count; ++i)
                        light_.transfer[c][b][i] += static_cast<float>(bounce_sum_[half][c][b][i] * scale);
                }
            }
            if (all.weights[upper][b] > 0)
                light_.sky_visibility[b] = static_cast<float>(visible_sum_[b] / all.weights[upper][b]);
            for (std::size_t c = 0; c < channel_count; ++c)
                light_.static_irradiance[c][b] =
                    static_cast<float>(direct_[c][b] + all.static_light[c][b] / light_.paths);
        }
        return light_;
    }

    const trace::Scene& scene_;
    const SampleTable& samples_;
    const IntegrationSettings& settings_;
    const RayWatch watch_;
    const glm::vec3 probe_;
    const std::array<std::uint32_t, max_sample_dimensions> shift_;
    const NextEvent next_event_;
    const bool lit_;

    std::array<Block, block_count> blocks_{};
    Block* block_ = nullptr;  // of the path at work
    std::array<Accumulator, 2> bounce_sum_{};
    std::array<double, basis_count> visible_sum_{};
    BasisSums direct_{};
    int misses_ = 0;  // that were looked at twice
    ProbeLight light_;
};

}  // namespace

std::uint32_t sample_dimensions(std::uint32_t bounces, bool with_lights) {
    const std::uint32_t paths = 2 + 2 * bounces;
    return with_lights ? std::min(paths + numbers_a_light * (bounces + 1), max_sample_dimensions) : paths;
}

ProbeLight integrate_probe(const trace::Scene& scene,
                           const StaticLights& lights,
                           const glm::ivec3& position_units,
                           const SampleTable& samples,
                           const IntegrationSettings& settings,
                           const RayWatch& watch) {
    return Integrator(scene, lights, position_units, samples, settings, watch).run();
}

}  // namespace drtv::bake
