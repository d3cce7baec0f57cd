#include "bakerd/reuse/first_rays.h"

#include "bakerd/bake/path.h"

#include <drtv/conventions.h>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace drtv::reuse {
namespace {

// Samples that start side by side.
constexpr std::size_t group_size = 8;

// Sky visibility is a mean over the upper half alone: so much more does a ray of it count there.
constexpr float upper_gain = 1 / open_sky_share(0);

// Of the height over the horizon. Grows with the height, and falls with the distance in plan where it is
// above.
float sine_of(float height, float plan) {
    return height == 0 && plan == 0 ? 1.0f : height / std::sqrt(height * height + plan * plan);
}

}  // namespace

// The part of the plane of sample numbers (uniform_sphere) in which the directions to a box lie; turns of the
// azimuth, counted from its middle.
struct FirstRays::Window {
    // Of u.x.
    float low_x = 0;
    float high_x = 1;
    // Of u.y.
    float middle_y = 0;
    float half_width_y = 1;

    [[nodiscard]] bool meets(const Square& square) const {
        if (square.x1 < low_x || square.x0 > high_x)
            return false;
        const float middle = (square.y0 + square.y1) / 2;
        const float off = std::abs(middle - middle_y);
        return std::min(off, 1 - off) <= half_width_y + (square.y1 - square.y0) / 2;
    }
};

FirstRays::Window FirstRays::window_of(const glm::vec3& from, const Bounds& box) {
    constexpr float rounding = 1e-4f;  // far more than what C libraries make of an arc tangent
    const glm::vec3 low = box.low - from;
    const glm::vec3 high = box.high - from;
    const glm::vec2 nearest(std::max({low.x, -high.x, 0.0f}), std::max({low.y, -high.y, 0.0f}));
    const glm::vec2 farthest(std::max(std::abs(low.x), std::abs(high.x)),
                             std::max(std::abs(low.y), std::abs(high.y)));
    const float near = glm::length(nearest);
    const float far = glm::length(farthest);
    const float highest = near == 0 && high.z > 0 ? 1 : sine_of(high.z, high.z > 0 ? near : far);
    const float lowest = near == 0 && low.z < 0 ? -1 : sine_of(low.z, low.z > 0 ? far : near);
    Window window;
    window.low_x = (1 - highest) / 2 - rounding;
    window.high_x = (1 - lowest) / 2 + rounding;
    if (near == 0)
        return window;
    constexpr float turns = 0.5f * std::numbers::inv_pi_v<float>;
    const glm::vec2 middle = glm::vec2(low + high) / 2.0f;
    window.middle_y = std::atan2(middle.y, middle.x) * turns;
    window.middle_y -= std::floor(window.middle_y);
    window.half_width_y = 0;
    for (const float x : {low.x, high.x}) {
        for (const float y : {low.y, high.y}) {
            // The angle between two directions of the plan; the box does not hold the start, so it is below
            // half a turn.
            const float across = middle.x * y - middle.y * x;
            const float along = middle.x * x + middle.y * y;
            const float angle = std::abs(std::atan2(across, along));
            window.half_width_y = std::max(window.half_width_y, angle * turns);
        }
    }
    window.half_width_y += rounding;
    return window;
}

FirstRays::FirstRays(const Footprint& footprint, const bake::SampleTable& samples, const trace::Scene& scene)
    : footprint_(footprint), samples_(samples), scene_(scene) {
    const std::size_t group_count = (samples.count() + group_size - 1) / group_size;
    for (const ProbeRecord& record : footprint.probes) {
        Probe& probe = probes_.emplace_back();
        probe.place = placement::metres(record.position);
        probe.shift = bake::digital_shift(record.position);
        for (std::size_t g = 0; g < group_count; ++g) {
            Square& square = probe.groups.emplace_back();
            for (const std::uint32_t n : members(g)) {
                const glm::vec2 u = bake::shifted(samples.point(n), probe.shift, 0);
                square.x0 = std::min(square.x0, u.x);
                square.x1 = std::max(square.x1, u.x);
                square.y0 = std::min(square.y0, u.y);
                square.y1 = std::max(square.y1, u.y);
            }
        }
    }
}

float FirstRays::weight_of(std::size_t number, std::span<const Bounds> boxes) const {
    const Probe& probe = probes_[number];
    std::vector<Window> windows;
    for (const Bounds& box : boxes) {
        if (distance(box, probe.place) <= farthest_m())
            windows.push_back(window_of(probe.place, box));
    }
    std::array<float, basis_count> sums{};
    for (std::size_t g = 0; g < probe.groups.size() && !windows.empty(); ++g) {
        const Square& square = probe.groups[g];
        if (std::ranges::none_of(windows, [&](const Window& window) { return window.meets(square); }))
            continue;
        for (const std::uint32_t n : members(g)) {
            const glm::vec3 direction = direction_of(probe, n);
            float enter_m = std::numeric_limits<float>::infinity();
            for (const Bounds& box : boxes)
                enter_m = std::min(enter_m, entry_distance(probe.place, direction, box));
            const trace::Ray ray{probe.place, direction, footprint_.reach_m};
            if (!(enter_m <= farthest_m()) || !may_come_to(ray, enter_m))
                continue;
            const float gain = direction.z > 0 ? upper_gain : 1;
            for (std::size_t b = 0; b < basis_count; ++b) {
                const auto& axis = transfer_basis[b];
                const float cosine = direction.x * axis[0] + direction.y * axis[1] + direction.z * axis[2];
                sums[b] += std::max(cosine, 1e-6f) * gain;
            }
        }
    }
    return *std::ranges::max_element(sums) * 4 / static_cast<float>(samples_.count());
}

// A step over a surface at the end of the reach may end behind it, by less than half of the way
// (before_surface).
float FirstRays::farthest_m() const {
    return footprint_.reach_m * 1.5f;
}

// Whether anything is asked about what lies `enter_m` along a first ray, or beyond. What stops the ray
// before is in both maps; where it is let through, so is all that it was asked for just behind.
bool FirstRays::may_come_to(const trace::Ray& ray, float enter_m) const {
    if (enter_m <= 0)
        return true;
    const auto steps_over = [&](const trace::Ray& first) -> std::optional<bool> {
        const float end_m = std::min(enter_m, first.far_m);
        const auto hit = scene_.closest({first.origin, first.direction, end_m});
        if (!hit)
            return std::nullopt;
        return bake::end_of_surface(first, *hit) >= enter_m;
    };
    if (const auto over = steps_over(ray))
        return *over;
    // The first misses are looked at twice (integrate.cpp).
    return enter_m <= ray.far_m || steps_over(trace::beside(ray)).value_or(false);
}

std::span<const std::uint32_t> FirstRays::members(std::size_t group) const {
    const std::size_t first = group * group_size;
    return samples_.side_by_side().subspan(first, std::min(group_size, samples_.count() - first));
}

glm::vec3 FirstRays::direction_of(const Probe& probe, std::uint32_t sample) const {
    return bake::uniform_sphere(bake::shifted(samples_.point(sample), probe.shift, 0));
}

}  // namespace drtv::reuse
