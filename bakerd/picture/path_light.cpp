#include "bakerd/picture/path_light.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drtv::picture {
namespace {

constexpr float inv_pi = std::numbers::inv_pi_v<float>;

}  // namespace

BasisColours colours_of(const PathBasis& basis, Show show) {
    BasisColours colours{};
    for (std::size_t b = 0; b < basis_count; ++b)
        colours[b] = as_float3(part_of(basis[b], show));
    return colours;
}

PathLight::PathLight(const Scenery& scenery, const Moment& moment, const PathSettings& settings)
    : scene_{scenery, moment, settings, {}} {
    for (const bake::LightSet& set : scenery.lights().sets())
        scene_.factors.push_back(moment.factor_of(set.name));
}

std::uint32_t PathLight::dimensions() const {
    return 2 + 2 * std::max(scene_.settings.bounces, scene_.settings.local_bounces);
}

PathParts PathLight::at_normal(const glm::vec3& place,
                               const glm::vec3& normal,
                               const bake::SampleTable& paths,
                               const glm::ivec3& seed) const {
    PathWalk walk(scene_, place, paths, seed);
    PathParts sum;
    const auto cosine = [&](const glm::vec3& w) { return std::max(glm::dot(normal, w), 0.0f); };
    const auto density = [&](const glm::vec3& w) { return cosine(w) * inv_pi; };
    const float share = 1 / static_cast<float>(paths.count());
    const auto add = [&](const glm::vec3& w, const glm::vec3& light, float counts) {
        sum.static_light += light * (counts * cosine(w));
    };
    for (std::uint32_t path = 0; path < paths.count(); ++path) {
        const glm::vec3 w = bake::cosine_hemisphere(walk.first_numbers(path), normal);
        if (!(density(w) > 0))
            continue;
        sum.add(walk.radiance(path, w, density(w)), glm::vec3(share));
        walk.drawn(
            path, density, [&](const glm::vec3& at, const glm::vec3& light) { add(at, light, share); });
    }
    walk.direct([&](const glm::vec3& at, const glm::vec3& light) { add(at, light, 1); });
    return sum;
}

PathBasis PathLight::at_basis(const glm::vec3& place,
                              const bake::SampleTable& paths,
                              const glm::ivec3& seed) const {
    PathWalk walk(scene_, place, paths, seed);
    PathBasis sum{};
    constexpr float uniform = inv_pi / 4;
    const float share = 1 / static_cast<float>(paths.count());
    const auto cosine = [](std::size_t b, const glm::vec3& w) {
        return std::max(glm::dot(as_vec(transfer_basis[b]), w), 0.0f);
    };
    const auto add = [&](const glm::vec3& w, const glm::vec3& light, float counts) {
        for (std::size_t b = 0; b < basis_count; ++b)
            sum[b].static_light += light * (counts * cosine(b, w));
    };
    for (std::uint32_t path = 0; path < paths.count(); ++path) {
        const glm::vec3 w = bake::uniform_sphere(walk.first_numbers(path));
        const PathParts radiance = walk.radiance(path, w, uniform);
        for (std::size_t b = 0; b < basis_count; ++b)
            sum[b].add(radiance, glm::vec3(4 * share * cosine(b, w)));
        walk.drawn(
            path,
            [](const glm::vec3&) { return uniform; },
            [&](const glm::vec3& at, const glm::vec3& light) { add(at, light, share); });
    }
    walk.direct([&](const glm::vec3& at, const glm::vec3& light) { add(at, light, 1); });
    return sum;
}

}  // namespace drtv::picture
