#include "tests/reference/reference_ambient.h"

#include "tests/reference/reference_walk.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <numbers>

namespace drtv::reference {
namespace {

using std::numbers::pi;

// What comes along one ray, by moment; radiance.
struct Arriving {
    glm::dvec3 sky{};
    glm::dvec3 sun{};
    glm::dvec3 local{};
};

class Gatherer {
  public:
    Gatherer(const Scene& scene, const glm::dvec3& point, std::span<const glm::dvec3> normals,
             std::span<const Moment> moments, const AmbientOptions& options)
        : normals_(normals),
          moments_(moments),
          options_(options),
          walk_{scene, point, options.reach_m, Random(options.seed)},
          map_lights_(walk_.lights()),
          result_(moments.size(), std::vector<AmbientLight>(normals.size())),
          arriving_(moments.size()) {}

    std::vector<std::vector<AmbientLight>> run() {
        const double side = options_.strata;
        for (std::uint32_t row = 0; row < options_.strata; ++row) {
            add_direct_light(1 / side);
            for (std::uint32_t column = 0; column < options_.strata; ++column) {
                const double u = (row + walk_.random.next()) / side;
                const double v = (column + walk_.random.next()) / side;
                add_ray(sphere_direction(u, v), 1 / (side * side));
            }
        }
        return std::move(result_);
    }

  private:
    // Of the map's lights without size; a try each, as blended surfaces may lie between.
    void add_direct_light(double weight) {
        for (const map::Light* light : map_lights_) {
            const auto incident = incidence(*light, walk_.probe);
            if (!incident)
                continue;
            const glm::dvec3 seen = incident->irradiance * walk_.lit(walk_.probe, *incident) * weight / pi;
            for_each_normal(incident->towards, [&](AmbientLight& at, std::size_t, double cosine) {
                at.static_light += seen * cosine;
            });
        }
    }

    void add_ray(const glm::dvec3& w, double weight) {
        glm::dvec3 tint(1);
        const auto hit = walk_.closest(walk_.probe, w, tint);
        const double share = 4 * weight;  // 1/pi over the density 1 / (4 pi)
        if (!hit) {
            for_each_normal(w, [&](AmbientLight& at, std::size_t moment, double cosine) {
                at.sky_direct += tint * sky(moment, w) * (cosine * share);
            });
            return;
        }
        std::ranges::fill(arriving_, Arriving{});
        own_ = glm::dvec3(0);
        follow(*hit, w, tint);
        for_each_normal(w, [&](AmbientLight& at, std::size_t moment, double cosine) {
            at.sky_bounce += arriving_[moment].sky * (cosine * share);
            at.sun_bounce += arriving_[moment].sun * (cosine * share);
            at.local += arriving_[moment].local * (cosine * share);
            at.static_light += own_ * (cosine * share);
        });
    }

    template <class Use>
    void for_each_normal(const glm::dvec3& w, const Use& use) {
        for (std::size_t n = 0; n < normals_.size(); ++n) {
            const double cosine = glm::dot(normals_[n], w);
            for (std::size_t m = 0; cosine > 0 && m < moments_.size(); ++m)
                use(result_[m][n], m, cosine);
        }
    }

    [[nodiscard]] glm::dvec3 sky(std::size_t moment, const glm::dvec3& w) const {
        const Moment& of = moments_[moment];
        return w.z > 0 && of.sky ? of.sky(w) : glm::dvec3(0);
    }

    void follow(SurfaceHit hit, glm::dvec3 arriving, const glm::dvec3& tint) {
        glm::dvec3 throughput = tint;
        glm::dvec3 origin = walk_.probe;
        const std::uint32_t most = std::max(options_.bounces, options_.local_bounces);
        for (std::uint32_t scattering = 1;; ++scattering) {
            const bool counts = scattering <= options_.bounces;
            if (hit.absorbs)
                return;
            if (scattering <= options_.bounces + 1)
                own_ += throughput * hit.emitted;
            if (scattering > most)
                return;
            const glm::dvec3 point = origin + hit.distance_m * arriving;
            if (counts)
                add_lights(hit, point, throughput);
            if (scattering <= options_.local_bounces)
                add_lamps(hit, point, throughput);
            const double u = walk_.random.next();
            const double v = walk_.random.next();
            const Walk::Step step = Walk::onward(hit, point, u, v);
            throughput *= step.weight;
            const auto next = walk_.closest(step.origin, step.direction, throughput);
            if (!next) {
                for (std::size_t m = 0; counts && m < moments_.size(); ++m)
                    arriving_[m].sky += throughput * sky(m, step.direction);
                return;
            }
            hit = *next;
            arriving = step.direction;
            origin = step.origin;
        }
    }

    void add_lights(const SurfaceHit& hit, const glm::dvec3& point, const glm::dvec3& throughput) {
        for (const map::Light* light : map_lights_) {
            if (const auto incident = incidence(*light, point))
                own_ += throughput * walk_.scattered(hit, point, *incident);
        }
        for (std::size_t m = 0; m < moments_.size(); ++m) {
            const Moment& moment = moments_[m];
            if (moment.to_sun.z <= 0 || moment.sun_irradiance == glm::dvec3(0))
                continue;
            const Incidence sun{moment.to_sun, std::numeric_limits<double>::infinity(),
                                moment.sun_irradiance};
            arriving_[m].sun += throughput * walk_.scattered(hit, point, sun);
        }
    }

    void add_lamps(const SurfaceHit& hit, const glm::dvec3& point, const glm::dvec3& throughput) {
        for (std::size_t m = 0; m < moments_.size(); ++m) {
            for (const GameLamp& lamp : moments_[m].lamps) {
                if (const auto incident = local_incidence(lamp.position, point))
                    arriving_[m].local +=
                        throughput * lamp.intensity * walk_.scattered(hit, point, *incident);
            }
        }
    }

    std::span<const glm::dvec3> normals_;
    std::span<const Moment> moments_;
    const AmbientOptions& options_;
    Walk walk_;
    std::vector<const map::Light*> map_lights_;
    std::vector<std::vector<AmbientLight>> result_;
    std::vector<Arriving> arriving_;  // of the present ray
    glm::dvec3 own_{};                // likewise, of the map's own lights
};

}  // namespace

std::vector<std::vector<AmbientLight>> ambient(const Scene& scene, const glm::dvec3& point,
                                               std::span<const glm::dvec3> normals,
                                               std::span<const Moment> moments,
                                               const AmbientOptions& options) {
    return Gatherer(scene, point, normals, moments, options).run();
}

}  // namespace drtv::reference
