#include "bakerd/picture/probe_spheres.h"

#include "format/kit/sector_folder.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace drtv::picture {
namespace {

constexpr float radius_m = 0.3f;
constexpr float min_radius_pixels = 2;
constexpr float farthest_m = 300;

}  // namespace

ProbeSpheres::ProbeSpheres(const Moment& moment, const Camera& camera)
    : mode_(moment.light().mode),
      tiles_wide_(camera.size().width / tile_pixels + 1),
      tiles_(tiles_wide_ * (camera.size().height / tile_pixels + 1)) {
    kit::for_each_sector(moment.set(), [&](const LoadedSector& sector) {
        for (std::size_t p = 0; p < sector.view.probe_count; ++p)
            add(sector, p, moment, camera);
    });
}

void ProbeSpheres::add(const LoadedSector& sector,
                       std::size_t probe,
                       const Moment& moment,
                       const Camera& camera) {
    Sphere sphere;
    sphere.centre = as_vec(position_m(sector.view, probe));
    const std::optional<Camera::Shown> shown = camera.show(sphere.centre);
    if (!shown || (shown->distance_m > farthest_m && !camera.is_parallel()))
        return;
    const float pixel_m = camera.pixel_m(shown->distance_m);
    sphere.radius_m = std::max(radius_m, min_radius_pixels * pixel_m);
    sphere.colours = clamped(relight(sector.view, probe, moment.light()));
    constexpr float spare = 1.2f;  // near by, its outline is wider than its middle
    const float reach = spare * camera.drawn_out(sphere.centre) * sphere.radius_m / pixel_m + 1;
    const auto tile_at = [](float pixel, std::size_t pixels) {
        const float inside = std::clamp(pixel, 0.0f, static_cast<float>(pixels - 1));
        return static_cast<std::size_t>(inside) / tile_pixels;
    };
    const glm::vec2 low = shown->pixel - reach;
    const glm::vec2 high = shown->pixel + reach;
    const Size size = camera.size();
    if (high.x < 0 || high.y < 0 || low.x > static_cast<float>(size.width) ||
        low.y > static_cast<float>(size.height))
        return;
    for (std::size_t y = tile_at(low.y, size.height); y <= tile_at(high.y, size.height); ++y) {
        for (std::size_t x = tile_at(low.x, size.width); x <= tile_at(high.x, size.width); ++x)
            tiles_[y * tiles_wide_ + x].push_back(static_cast<std::uint32_t>(spheres_.size()));
    }
    spheres_.push_back(sphere);
}

std::optional<ProbeSpheres::Met> ProbeSpheres::first_on(const trace::Ray& ray, glm::vec2 pixel) const {
    const auto x = static_cast<std::size_t>(pixel.x) / tile_pixels;
    const auto y = static_cast<std::size_t>(pixel.y) / tile_pixels;
    std::optional<Met> first;
    for (const std::uint32_t n : tiles_[y * tiles_wide_ + x]) {
        const Sphere& sphere = spheres_[n];
        const glm::vec3 way = sphere.centre - ray.origin;
        const float along = glm::dot(way, ray.direction);
        const float inside = sphere.radius_m * sphere.radius_m - (glm::dot(way, way) - along * along);
        if (inside < 0)
            continue;
        const float distance_m = along - std::sqrt(inside);
        if (distance_m <= 0 || (first && first->distance_m <= distance_m))
            continue;
        const glm::vec3 normal = (ray.direction * distance_m - way) / sphere.radius_m;
        first = Met{distance_m, as_vec(shade_ambient(mode_, sphere.colours, as_float3(normal)))};
    }
    return first;
}

}  // namespace drtv::picture
