#include "tests/reference/reference_integrator.h"

#include "tests/reference/reference_walk.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace drtv::reference {
namespace {

using std::numbers::pi;

// What comes to the probe along one ray.
struct Radiance {
    std::array<std::array<double, sh_count>, channel_count>
        sky{};            // by bounce, when the sky's radiance is Y_i
    glm::dvec3 lights{};  // emission seen and all bounces
};

struct Batch {
    Transfer transfer{};
    Visibility visibility{};
    Irradiance irradiance{};
};

class Integrator {
  public:
    Integrator(const Scene& scene, const glm::dvec3& position, const Options& options)
        : options_(options),
          walk_{scene, position, options.reach_m, Random(options.seed)},
          lights_(walk_.lights()) {}

    Batch run_batch() {
        Batch batch;
        const double side = options_.strata;
        for (std::uint32_t row = 0; row < options_.strata; ++row) {
            add_direct_light(1 / side, batch);
            for (std::uint32_t column = 0; column < options_.strata; ++column) {
                const double u = (row + walk_.random.next()) / side,
                             v = (column + walk_.random.next()) / side;
                add_first_ray(sphere_direction(u, v), 1 / (side * side), batch);
            }
        }
        return batch;
    }

  private:
    // Of the lights without size; a try each, as blended surfaces may lie between.
    void add_direct_light(double weight, Batch& batch) {
        for (const map::Light* light : lights_) {
            const auto incident = incidence(*light, walk_.probe);
            if (!incident)
                continue;
            const glm::dvec3 light_seen = incident->irradiance * walk_.lit(walk_.probe, *incident);
            for (std::size_t b = 0; b < basis_count; ++b) {
                const double share = weight * std::max(0.0, glm::dot(incident->towards, basis[b])) / pi;
                for (std::size_t c = 0; c < channel_count; ++c)
                    batch.irradiance[c][b] += share * light_seen[static_cast<glm::length_t>(c)];
            }
        }
    }

    void add_first_ray(const glm::dvec3& w, double weight, Batch& batch) {
        glm::dvec3 tint(1);
        const auto hit = walk_.closest(walk_.probe, w, tint);
        if (!hit) {
            const double seen = glm::dot(tint, {0.2126, 0.7152, 0.0722});
            for (std::size_t b = 0; b < basis_count && w.z > 0; ++b)
                batch.visibility[b] += seen * weight * 4 * pi * std::max(0.0, glm::dot(w, basis[b]));
            return;
        }
        Radiance radiance;
        const double side = options_.continuation_strata;
        for (std::uint32_t row = 0; row < options_.continuation_strata; ++row) {
            for (std::uint32_t column = 0; column < options_.continuation_strata; ++column) {
                const double u = (row + walk_.random.next()) / side,
                             v = (column + walk_.random.next()) / side;
                follow(*hit, w, u, v, tint / (side * side), radiance);
            }
        }
        for (std::size_t b = 0; b < basis_count; ++b) {
            const double share =
                weight * 4 * std::max(0.0, glm::dot(w, basis[b]));  // 1 / pi over the density 1 / (4 pi)
            for (std::size_t c = 0; c < channel_count; ++c) {
                for (std::size_t i = 0; i < sh_count; ++i)
                    batch.transfer[c][b][i] += share * radiance.sky[c][i];
                batch.irradiance[c][b] += share * radiance.lights[static_cast<glm::length_t>(c)];
            }
        }
    }

    // One sample of what the surface that `arriving` hit sends back along it, times `weight`. The first
    // direction onward is made of `u` and `v`.
    void follow(SurfaceHit hit, glm::dvec3 arriving, double u, double v, const glm::dvec3& weight,
                Radiance& radiance) {
        glm::dvec3 throughput(weight), origin = walk_.probe;
        for (std::uint32_t scattering = 1;; ++scattering) {
            if (hit.absorbs)
                return;
            radiance.lights += throughput * hit.emitted;
            if (scattering > options_.bounces)
                return;
            const glm::dvec3 point = origin + hit.distance_m * arriving;
            for (const map::Light* light : lights_) {
                if (const auto incident = incidence(*light, point))
                    radiance.lights += throughput * walk_.scattered(hit, point, *incident);
            }
            const Walk::Step step = Walk::onward(hit, point, u, v);
            throughput *= step.weight;
            const auto next = walk_.closest(step.origin, step.direction, throughput);
            if (!next) {
                if (step.direction.z > 0)
                    add_sky(step.direction, throughput, radiance);  // below the horizon it is black
                return;
            }
            hit = *next;
            arriving = step.direction;
            origin = step.origin;
            u = walk_.random.next();
            v = walk_.random.next();
        }
    }

    static void add_sky(const glm::dvec3& w, const glm::dvec3& throughput, Radiance& radiance) {
        const std::array<double, sh_count> sh = {y0, y1 * w.y, y1 * w.z, y1 * w.x};
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t i = 0; i < sh_count; ++i)
                radiance.sky[c][i] += throughput[static_cast<glm::length_t>(c)] * sh[i];
        }
    }

    const Options& options_;
    Walk walk_;
    std::vector<const map::Light*> lights_;
};

}  // namespace

Estimate integrate(const Scene& scene, const glm::dvec3& position, const Options& options) {
    Integrator integrator(scene, position, options);
    std::array<std::array<std::array<Spread, sh_count>, basis_count>, channel_count> transfer{};
    std::array<std::array<Spread, basis_count>, channel_count> irradiance{};
    std::array<Spread, basis_count> visibility{};
    for (std::uint32_t n = 0; n < options.batches; ++n) {
        const Batch batch = integrator.run_batch();
        for (std::size_t b = 0; b < basis_count; ++b) {
            const double open = pi * (1 + basis[b].z) / 2;  // int_up max(0, w.b) dw
            visibility[b].add(open > 1e-9 ? batch.visibility[b] / open : 0);
            for (std::size_t c = 0; c < channel_count; ++c) {
                irradiance[c][b].add(batch.irradiance[c][b]);
                for (std::size_t i = 0; i < sh_count; ++i)
                    transfer[c][b][i].add(batch.transfer[c][b][i]);
            }
        }
    }
    Estimate estimate;
    const double batches = options.batches;
    for (std::size_t b = 0; b < basis_count; ++b) {
        estimate.sky_visibility[b] = visibility[b].mean(batches);
        estimate.visibility_error[b] = visibility[b].error(batches);
        for (std::size_t c = 0; c < channel_count; ++c) {
            estimate.static_irradiance[c][b] = irradiance[c][b].mean(batches);
            estimate.static_error[c][b] = irradiance[c][b].error(batches);
            for (std::size_t i = 0; i < sh_count; ++i) {
                estimate.transfer[c][b][i] = transfer[c][b][i].mean(batches);
                estimate.transfer_error[c][b][i] = transfer[c][b][i].error(batches);
            }
        }
    }
    return estimate;
}

}  // namespace drtv::reference
