#include "tests/reference/reference_integrator.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace drtv::reference {
namespace {

using std::numbers::pi;

// Far over double's rounding at 100 km, far under anything modelled.
constexpr double surface_offset_m = 1e-7;

struct Random {
    std::mt19937_64 engine;
    double next() { return static_cast<double>(engine() >> 11) * 0x1p-53; }
};

// Uniform on the sphere for u and v in [0, 1).
glm::dvec3 sphere_direction(double u, double v) {
    const double z = 1 - 2 * u, r = std::sqrt(std::max(0.0, 1 - z * z)), angle = 2 * pi * v;
    return {r * std::cos(angle), r * std::sin(angle), z};
}

// Uniform on the hemisphere around the unit `normal`.
glm::dvec3 hemisphere_direction(double u, double v, const glm::dvec3& normal) {
    const glm::dvec3 local = sphere_direction(u / 2, v);
    const glm::dvec3 aside = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 tangent = glm::normalize(glm::cross(aside, normal));
    return local.x * tangent + local.y * glm::cross(normal, tangent) + local.z * normal;
}

struct Integrator {
    const Scene& scene;
    const glm::dvec3& probe;
    const Options& options;
    Random random;

    // A hit outside the sphere of reach around the probe is none; beyond it there is nothing to come back from.
    [[nodiscard]] std::optional<SurfaceHit> closest(const glm::dvec3& origin, const glm::dvec3& direction) const {
        auto hit = scene.closest(origin, direction);
        if (hit && glm::length(origin + hit->distance_m * direction - probe) > options.reach_m) hit.reset();
        return hit;
    }

    // One sample of Lout_{c,i}(hit, -arriving): adds it, times `weight`, to radiance[c][i]. The first direction is made
    // of `u` and `v`.
    void follow(SurfaceHit hit, glm::dvec3 origin, glm::dvec3 arriving, double u, double v, double weight, std::array<std::array<double, sh_count>, channel_count>& radiance) {
        glm::dvec3 throughput(weight);
        for (std::uint32_t touched = 1; touched <= options.bounces; ++touched) {
            if (hit.absorbs) return;
            origin += hit.distance_m * arriving + surface_offset_m * hit.normal;
            const glm::dvec3 leaving = hemisphere_direction(u, v, hit.normal);
            // Lambert: albedo / pi, times the cosine, over the density 1 / (2 pi) of the hemisphere.
            throughput *= hit.albedo * (2 * glm::dot(leaving, hit.normal));
            const auto next = closest(origin, leaving);
            if (!next) {
                if (leaving.z <= 0) return;  // below the horizon it is black
                const std::array<double, sh_count> sh = {y0, y1 * leaving.y, y1 * leaving.z, y1 * leaving.x};
                for (std::size_t c = 0; c < channel_count; ++c) {
                    for (std::size_t i = 0; i < sh_count; ++i) radiance[c][i] += throughput[static_cast<glm::length_t>(c)] * sh[i];
                }
                return;
            }
            hit = *next;
            arriving = leaving;
            u = random.next();
            v = random.next();
        }
    }

    void add_first_ray(const glm::dvec3& w, Transfer& transfer, Visibility& visibility) {
        const auto hit = closest(probe, w);
        if (!hit) {
            for (std::size_t b = 0; b < basis_count && w.z > 0; ++b) visibility[b] += 4 * pi * std::max(0.0, glm::dot(w, basis[b]));
            return;
        }
        std::array<std::array<double, sh_count>, channel_count> radiance{};
        const double side = options.continuation_strata;
        for (std::uint32_t row = 0; row < options.continuation_strata; ++row) {
            for (std::uint32_t column = 0; column < options.continuation_strata; ++column) {
                const double u = (row + random.next()) / side, v = (column + random.next()) / side;
                follow(*hit, probe, w, u, v, 1 / (side * side), radiance);
            }
        }
        for (std::size_t b = 0; b < basis_count; ++b) {
            const double weight = 4 * std::max(0.0, glm::dot(w, basis[b]));  // 1 / pi over the density 1 / (4 pi)
            for (std::size_t c = 0; c < channel_count; ++c) {
                for (std::size_t i = 0; i < sh_count; ++i) transfer[c][b][i] += weight * radiance[c][i];
            }
        }
    }
};

// Mean and standard error from sums over batches.
struct Spread {
    double sum = 0, squares = 0;
    void add(double v) { sum += v, squares += v * v; }
    [[nodiscard]] double mean(double n) const { return sum / n; }
    [[nodiscard]] double error(double n) const { return std::sqrt(std::max(0.0, squares / n - mean(n) * mean(n)) / (n - 1)); }
};

}  // namespace

Estimate integrate(const Scene& scene, const glm::dvec3& position, const Options& options) {
    Integrator integrator{scene, position, options, {std::mt19937_64(options.seed)}};
    std::array<std::array<std::array<Spread, sh_count>, basis_count>, channel_count> transfer_spread{};
    std::array<Spread, basis_count> visibility_spread{};
    const double side = options.strata, rays = side * side, batches = options.batches;
    for (std::uint32_t batch = 0; batch < options.batches; ++batch) {
        Transfer transfer{};
        Visibility visibility{};
        for (std::uint32_t row = 0; row < options.strata; ++row) {
            for (std::uint32_t column = 0; column < options.strata; ++column) {
                const double u = (row + integrator.random.next()) / side, v = (column + integrator.random.next()) / side;
                integrator.add_first_ray(sphere_direction(u, v), transfer, visibility);
            }
        }
        for (std::size_t b = 0; b < basis_count; ++b) {
            const double open = pi * (1 + basis[b].z) / 2;  // int_up max(0, w.b) dw
            visibility_spread[b].add(open > 1e-9 ? visibility[b] / rays / open : 0);
            for (std::size_t c = 0; c < channel_count; ++c) {
                for (std::size_t i = 0; i < sh_count; ++i) transfer_spread[c][b][i].add(transfer[c][b][i] / rays);
            }
        }
    }
    Estimate estimate;
    for (std::size_t b = 0; b < basis_count; ++b) {
        estimate.sky_visibility[b] = visibility_spread[b].mean(batches);
        estimate.visibility_error[b] = visibility_spread[b].error(batches);
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t i = 0; i < sh_count; ++i) {
                estimate.transfer[c][b][i] = transfer_spread[c][b][i].mean(batches);
                estimate.transfer_error[c][b][i] = transfer_spread[c][b][i].error(batches);
            }
        }
    }
    return estimate;
}

}  // namespace drtv::reference
