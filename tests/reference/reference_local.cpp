#include "tests/reference/reference_local.h"

#include "tests/reference/reference_walk.h"

#include <numbers>

namespace drtv::reference {
namespace {

using std::numbers::pi;

// The cosine lobe's share of a band (Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance
// Environment Maps", 2001), over pi: what makes SH of E/pi out of SH of radiance.
constexpr std::array<double, sh_count> band_share = {1, 2.0 / 3, 2.0 / 3, 2.0 / 3};

// Radiance at the receiver along `w` from each source, by bounce.
void follow(Walk& walk, const glm::dvec3& w, std::span<const glm::dvec3> sources, std::uint32_t bounces,
            std::vector<glm::dvec3>& radiance) {
    glm::dvec3 origin = walk.probe, arriving = w, throughput(1);
    for (std::uint32_t scattering = 1; scattering <= bounces; ++scattering) {
        const auto hit = walk.closest(origin, arriving, throughput);
        if (!hit || hit->absorbs)
            return;
        const glm::dvec3 point = origin + hit->distance_m * arriving;
        for (std::size_t s = 0; s < sources.size(); ++s) {
            if (!walk.within_reach(sources[s]))
                continue;
            if (const auto incident = local_incidence(sources[s], point))
                radiance[s] += throughput * walk.scattered(*hit, point, *incident);
        }
        const double u = walk.random.next(), v = walk.random.next();
        const Walk::Step step = Walk::onward(*hit, point, u, v);
        throughput *= step.weight;
        origin = step.origin;
        arriving = step.direction;
    }
}

}  // namespace

std::vector<LocalEstimate> integrate_local(const Scene& scene, const glm::dvec3& receiver,
                                           std::span<const glm::dvec3> sources, const LocalOptions& options) {
    Walk walk{scene, receiver, options.reach_m, Random(options.seed)};
    std::vector<std::array<std::array<Spread, sh_count>, channel_count>> spread(sources.size());
    const double side = options.strata, batches = options.batches;
    std::vector<glm::dvec3> radiance;
    for (std::uint32_t batch = 0; batch < options.batches; ++batch) {
        std::vector<LocalTransfer> sum(sources.size());
        for (std::uint32_t row = 0; row < options.strata; ++row) {
            for (std::uint32_t column = 0; column < options.strata; ++column) {
                const double u = (row + walk.random.next()) / side, v = (column + walk.random.next()) / side;
                const glm::dvec3 w = sphere_direction(u, v);
                radiance.assign(sources.size(), glm::dvec3(0));
                follow(walk, w, sources, options.bounces, radiance);
                const std::array<double, sh_count> sh = {y0, y1 * w.y, y1 * w.z, y1 * w.x};
                for (std::size_t s = 0; s < sources.size(); ++s) {
                    for (std::size_t c = 0; c < channel_count; ++c) {
                        for (std::size_t i = 0; i < sh_count; ++i)
                            sum[s][c][i] += radiance[s][static_cast<glm::length_t>(c)] * sh[i];
                    }
                }
            }
        }
        for (std::size_t s = 0; s < sources.size(); ++s) {
            for (std::size_t c = 0; c < channel_count; ++c) {
                for (std::size_t i = 0; i < sh_count; ++i)
                    spread[s][c][i].add(sum[s][c][i] * band_share[i] * 4 * pi / (side * side));
            }
        }
    }
    std::vector<LocalEstimate> estimates(sources.size());
    for (std::size_t s = 0; s < sources.size(); ++s) {
        for (std::size_t c = 0; c < channel_count; ++c) {
            for (std::size_t i = 0; i < sh_count; ++i) {
                estimates[s].transfer[c][i] = spread[s][c][i].mean(batches);
                estimates[s].transfer_error[c][i] = spread[s][c][i].error(batches);
            }
        }
    }
    return estimates;
}

}  // namespace drtv::reference
