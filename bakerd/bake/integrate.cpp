// The estimator. First directions are uniform on the sphere; further ones follow the cosine of the surface, so
// that a path's weight is the product of albedos. What a path brings is the sky's SH at the direction in which it
// leaves. Upper and lower half of the first directions are normalised apart, each by the sum of its own basis
// cosines over the same samples: an open sky, a plane and the energy bound then hold exactly, whatever the samples.
#include "bakerd/bake/integrate.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace drtv::bake {
namespace {

using Accumulator = std::array<std::array<std::array<double, sh_count>, basis_count>, channel_count>;
using BasisWeights = std::array<float, basis_count>;

enum Half : std::size_t { upper, lower };

BasisWeights basis_weights(const glm::vec3& w) {
    BasisWeights weights{};
    for (std::size_t b = 0; b < basis_count; ++b) {
        weights[b] = std::max(0.0f, w.x * transfer_basis[b][0] + w.y * transfer_basis[b][1] + w.z * transfer_basis[b][2]);
    }
    return weights;
}

// The share of a cosine lobe around the basis direction that lies above the horizon.
double upper_share(std::size_t b) { return (1 + static_cast<double>(transfer_basis[b][2])) / 2; }

// A start for the next ray, certainly on the same side of every surface as the way that led here: a point of that
// way, which is known to be free, where it is still clear of the surface by the coordinates' rounding. Where the
// whole way runs closer to the surface than that (in the last micrometres of a crevice) there is no such point,
// and the path ends: better a path lost than light through a wall.
std::optional<glm::vec3> leave_surface(const trace::Ray& ray, const trace::Hit& hit) {
    const glm::vec3 point = ray.origin + ray.direction * hit.distance_m;
    const float magnitude = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z), 1.0f});
    const float clearance = magnitude * 0x1p-20f;  // 8 to 16 times the coordinates' last digit
    const float cosine = -glm::dot(ray.direction, hit.normal);
    const float back = clearance / cosine;
    if (!(back <= hit.distance_m / 2)) return std::nullopt;
    return ray.origin + ray.direction * (hit.distance_m - back);
}

// Where a ray leaves the sphere of what the probe can see; 0 when it starts outside.
float exit_distance(const trace::Ray& ray, const glm::vec3& centre, float radius) {
    const glm::vec3 m = ray.origin - centre;
    const float b = glm::dot(m, ray.direction), c = glm::dot(m, m) - radius * radius;
    return c >= 0 ? 0 : -b + std::sqrt(b * b - c);
}

class Integrator {
  public:
    Integrator(const trace::Scene& scene, const glm::ivec3& position_units, const SampleTable& samples, const IntegrationSettings& settings, std::vector<trace::Ray>* shot)
        : scene_(scene), samples_(samples), settings_(settings), shot_(shot), probe_(glm::vec3(position_units) * position_unit_m), shift_(digital_shift(position_units)) {}

    ProbeLight run() {
        for (std::uint32_t n = 0; n < samples_.count(); ++n) trace_path(samples_.point(n));
        return normalised();
    }

  private:
    [[nodiscard]] glm::vec2 sample(std::span<const std::uint32_t> point, std::size_t dimension) const {
        return {unit_float(point[dimension] ^ shift_[dimension]), unit_float(point[dimension + 1] ^ shift_[dimension + 1])};
    }

    void trace_path(std::span<const std::uint32_t> point) {
        trace::Ray ray{probe_, uniform_sphere(sample(point, 0)), settings_.reach_m};
        const BasisWeights weights = basis_weights(ray.direction);
        const Half half = ray.direction.z > 0 ? upper : lower;
        for (std::size_t b = 0; b < basis_count; ++b) weight_sum_[half][b] += weights[b];

        glm::vec3 throughput(1);
        for (std::uint32_t bounce = 0;; ++bounce) {
            ++light_.rays;
            if (shot_ != nullptr) shot_->push_back(ray);
            const std::optional<trace::Hit> hit = scene_.closest(ray);
            if (!hit) {
                if (bounce == 0) add_sky(weights, half);
                else if (ray.direction.z > 0) add_bounce(weights, half, throughput, ray.direction);
                return;
            }
            if (bounce == settings_.bounces) return;
            const trace::Surface surface = scene_.surface(*hit);
            if (surface.absorbs) {
                ++light_.back_hits;
                return;
            }
            const std::optional<glm::vec3> start = leave_surface(ray, *hit);
            if (!start) return;
            throughput *= surface.albedo;
            ray.origin = *start;
            ray.direction = cosine_hemisphere(sample(point, 2 + 2 * std::size_t{bounce}), hit->normal);
            ray.far_m = exit_distance(ray, probe_, settings_.reach_m);
        }
    }

    void add_sky(const BasisWeights& weights, Half half) {
        if (half == lower) return;
        for (std::size_t b = 0; b < basis_count; ++b) visible_sum_[b] += weights[b];
    }

    void add_bounce(const BasisWeights& weights, Half half, const glm::vec3& throughput, const glm::vec3& out) {
        const Float4 y = evaluate_sh({out.x, out.y, out.z});
        for (std::size_t c = 0; c < channel_count; ++c) {
            const float radiance = throughput[static_cast<glm::length_t>(c)];
            for (std::size_t b = 0; b < basis_count; ++b) {
                for (std::size_t i = 0; i < sh_count; ++i) bounce_sum_[half][c][b][i] += static_cast<double>(weights[b] * radiance * y[i]);
            }
        }
    }

    ProbeLight normalised() {
        for (std::size_t b = 0; b < basis_count; ++b) {
            const std::array<double, 2> share = {upper_share(b), 1 - upper_share(b)};
            for (std::size_t half : {upper, lower}) {
                if (weight_sum_[half][b] <= 0) continue;
                const double scale = share[half] / weight_sum_[half][b];
                for (std::size_t c = 0; c < channel_count; ++c) {
                    for (std::size_t i = 0; i < sh_count; ++i) light_.transfer[c][b][i] += static_cast<float>(bounce_sum_[half][c][b][i] * scale);
                }
            }
            if (weight_sum_[upper][b] > 0) light_.sky_visibility[b] = static_cast<float>(visible_sum_[b] / weight_sum_[upper][b]);
        }
        return light_;
    }

    const trace::Scene& scene_;
    const SampleTable& samples_;
    const IntegrationSettings& settings_;
    std::vector<trace::Ray>* const shot_;
    const glm::vec3 probe_;
    const std::array<std::uint32_t, max_sample_dimensions> shift_;

    std::array<std::array<double, basis_count>, 2> weight_sum_{};  // by half of the first direction
    std::array<Accumulator, 2> bounce_sum_{};
    std::array<double, basis_count> visible_sum_{};
    ProbeLight light_;
};

}  // namespace

ProbeLight integrate_probe(const trace::Scene& scene, const glm::ivec3& position_units, const SampleTable& samples, const IntegrationSettings& settings, std::vector<trace::Ray>* shot) {
    return Integrator(scene, position_units, samples, settings, shot).run();
}

}  // namespace drtv::bake
