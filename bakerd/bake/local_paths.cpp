#include "bakerd/bake/local_paths.h"

#include "bakerd/bake/path.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <optional>

namespace drtv::bake {
namespace {

float square(float x) {
    return x * x;
}

// What the first point of a path says of all its ends.
void set_first_point(PathEnd& end, const trace::Ray& ray, const trace::Hit& hit) {
    const float cosine = -glm::dot(ray.direction, hit.normal);
    const float squared = square(hit.distance_m);
    end.first = end.position;
    end.to_receiver = cosine / squared;
    end.density = end.to_receiver;
    end.from_light = cosine / std::max(squared, square(local_least_distance_m));
    end.direction = irradiance_sh(ray.direction);
    end.density_front = 1;
    end.density_back = 1;
}

class LocalPath {
  public:
    LocalPath(const LocalPathStart& start, std::uint32_t number, RayWatch* watch)
        : start_(start), number_(number), numbers_(start.samples.point(number)), watch_(watch) {
        ray_ = {start.source, uniform_sphere(shifted(numbers_, start.shift, 0)), start.settings.reach_m};
    }

    [[nodiscard]] std::uint64_t rays() const { return rays_; }

    // Traces one ray and adds its end. Whether the path goes on.
    bool step(std::uint32_t bounce, EndGroup& group) {
        ++rays_;
        const std::optional<trace::Hit> hit = start_.scene.closest(ray_);
        watch(end_of(ray_, hit));
        if (!hit)
            return false;
        pass_glass(hit->distance_m, bounce);
        footprint_m_ += hit->distance_m * later_footprint;
        const trace::Surface surface = start_.scene.surface(*hit, footprint_m_);
        if (surface.absorbs)
            return false;
        const std::optional<glm::vec3> before = before_surface(ray_, *hit);
        if (!before)
            return false;
        const float through_share = transmitted_share(surface);
        if (through_share > 0)
            watch(end_of_surface(ray_, *hit));
        end_.position = ray_.origin + ray_.direction * hit->distance_m;
        end_.normal = hit->normal;
        end_.before = *before;
        end_.beyond = through_share > 0 ? beyond_surface(start_.scene, ray_, *hit) : std::nullopt;
        end_.albedo = carried_ * surface.albedo;
        end_.transmitted = carried_ * surface.transmitted;
        if (bounce == 0) {
            set_first_point(end_, ray_, *hit);
        } else {
            end_.density_front = 1 - through_share;
            end_.density_back = through_share;
        }
        group.add(end_);
        return bounce + 1 < start_.settings.bounces && scatter_from(*hit, surface, bounce);
    }

  private:
    void pass_glass(float distance_m, std::uint32_t bounce) {
        const auto passed = start_.scene.passed({ray_.origin, ray_.direction, distance_m});
        carried_ *= passed.tint;
        if (bounce == 0)
            end_.share_back = passed.share;
    }

    bool scatter_from(const trace::Hit& hit, const trace::Surface& surface, std::uint32_t bounce) {
        const glm::vec2 u = shifted(numbers_, start_.shift, 2 + 2 * std::size_t{bounce});
        const std::optional<Scattered> next = scatter(start_.scene, ray_, hit, surface, u);
        if (!next)
            return false;
        const float through_share = transmitted_share(surface);
        const float probability = next->through ? through_share : 1 - through_share;
        const glm::vec3& sent_on = next->through ? surface.transmitted : surface.albedo;
        // The first point's own draw of a side is this source's alone to make; those between, both directions
        // share.
        if (bounce == 0) {
            end_.density *= probability;
            carried_ *= sent_on;
        } else {
            carried_ *= sent_on / probability;
        }
        const float far_m =
            exit_distance(next->origin, next->direction, start_.source, start_.settings.reach_m);
        ray_ = {next->origin, next->direction, far_m};
        return true;
    }

    // Neighbours' probes are sources too, so that not even first segments are implied.
    void watch(float length_m) {
        if (watch_ == nullptr)
            return;
        const PathSegment segment{ray_, length_m, whole_range, number_, false};
        watch_->record_segments({&segment, 1});
    }

    const LocalPathStart& start_;
    const std::uint32_t number_;
    const std::span<const std::uint32_t> numbers_;
    RayWatch* const watch_;
    trace::Ray ray_;
    PathEnd end_;
    glm::vec3 carried_ = glm::vec3(1);
    float footprint_m_ = 0;
    std::uint64_t rays_ = 0;
};

}  // namespace

std::uint64_t trace_local_path(const LocalPathStart& start,
                               std::uint32_t number,
                               std::span<EndGroup> groups,
                               RayWatch* watch) {
    LocalPath path(start, number, watch);
    for (std::uint32_t bounce = 0; bounce < groups.size(); ++bounce) {
        if (!path.step(bounce, groups[bounce]))
            break;
    }
    return path.rays();
}

}  // namespace drtv::bake
