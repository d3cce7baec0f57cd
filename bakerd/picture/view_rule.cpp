#include "bakerd/picture/view_rule.h"

#include "bakerd/map/cos_sin.h"
#include "bakerd/picture/camera.h"
#include "bakerd/picture/film.h"
#include "bakerd/picture/ground_probes.h"
#include "bakerd/trace/device.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace drtv::picture {
namespace {

constexpr float eye_m = 1.7f;
constexpr float probe_m = 1;  // over the ground
constexpr float min_distance_m = 2;
constexpr float max_sky = 0.6f;
constexpr std::size_t min_objects = 3;
constexpr float wanted_sky = 0.3f;
constexpr float near_log2 = 3;  // 8 m
constexpr std::size_t max_eyes = 240;
constexpr std::size_t ways = 12;
constexpr Size grid = {24, 14};  // rays of a view
constexpr float fov_deg = 60;

std::vector<glm::vec3> eyes_of(const SectorSet& set) {
    std::vector<glm::vec3> eyes;
    for_each_ground_probe(
        set, [&](const glm::vec3& place) { eyes.push_back(place + glm::vec3(0, 0, eye_m - probe_m)); });
    const std::size_t count = std::min(max_eyes, eyes.size());
    std::vector<glm::vec3> chosen;
    for (std::size_t n = 0; n < count; ++n)
        chosen.push_back(eyes[(2 * n + 1) * eyes.size() / (2 * count)]);
    return chosen;
}

struct Judged {
    View view;
    float score = -INFINITY;
};

class Looking {
  public:
    explicit Looking(const trace::Scene& scene) : scene_(scene) {}

    Judged judge(const View& view) {
        const Camera camera = Camera::at(view.eye, view.look, fov_deg, grid);
        objects_.clear();
        depths_.clear();
        for (std::size_t n = 0; n < grid.width * grid.height; ++n) {
            const trace::Ray ray = camera.ray(glm::vec2(n % grid.width, n / grid.width) + 0.5f);
            const std::optional<trace::Hit> hit = scene_.closest(ray);
            if (!hit)
                continue;
            if (hit->distance_m < min_distance_m || scene_.surface(*hit, 1).absorbs)
                return {view, -INFINITY};
            objects_.push_back(scene_.object_index(hit->instance));
            depths_.push_back(static_cast<float>(log2_of(static_cast<double>(hit->distance_m))));
        }
        return {view, score()};
    }

  private:
    float score() {
        if (depths_.empty())
            return -INFINITY;
        const std::vector<float> shares = shares_of_objects();
        const auto hits = static_cast<float>(depths_.size());
        const float sky = 1 - hits / static_cast<float>(grid.width * grid.height);
        float mean = 0;
        for (const float depth : depths_)
            mean += depth / hits;
        float spread = 0;
        for (const float depth : depths_)
            spread += (depth - mean) * (depth - mean) / hits;
        const auto near =
            static_cast<float>(std::ranges::count_if(depths_, [](float d) { return d < near_log2; })) / hits;
        // What looks alike all over says little, however many objects there are: entropy, in bits.
        float variety = 0;
        for (const float share : shares)
            variety -= share * static_cast<float>(log2_of(static_cast<double>(share)));
        const float worth = std::min(variety, 6.0f) / 3 + std::min(std::sqrt(spread), 2.0f) / 2 -
                            1.5f * std::abs(sky - wanted_sky) - 2 * near;
        const bool is_good = sky <= max_sky && shares.size() >= min_objects;
        return is_good ? worth : worth - 10;
    }

    // Of the rays that meet something.
    std::vector<float> shares_of_objects() {
        std::ranges::sort(objects_);
        std::vector<float> shares;
        for (auto first = objects_.begin(); first != objects_.end();) {
            const auto last = std::upper_bound(first, objects_.end(), *first);
            shares.push_back(static_cast<float>(last - first) / static_cast<float>(objects_.size()));
            first = last;
        }
        return shares;
    }

    const trace::Scene& scene_;
    std::vector<std::uint32_t> objects_;
    std::vector<float> depths_;  // log2 of metres
};

}  // namespace

std::optional<View> view_by_rule(const trace::Scene& scene, const SectorSet& set) {
    const std::vector<glm::vec3> eyes = eyes_of(set);
    std::vector<Judged> best(eyes.size());
    tbb::parallel_for(std::size_t{0}, eyes.size(), [&](std::size_t n) {
        const trace::FloatMode float_mode;
        Looking looking(scene);
        for (std::size_t way = 0; way < ways; ++way) {
            constexpr double step = 2 * std::numbers::pi / ways;
            const glm::dvec2 around = map::cos_sin((static_cast<double>(way) + 0.5) * step);
            constexpr float ahead_m = 20;
            constexpr float down_m = 1;
            const glm::vec3 ahead(glm::vec2(around) * ahead_m, -down_m);
            const Judged judged = looking.judge({eyes[n], eyes[n] + ahead});
            if (judged.score > best[n].score)
                best[n] = judged;
        }
    });
    const auto chosen = std::ranges::max_element(best, {}, &Judged::score);
    if (chosen == best.end() || chosen->score == -INFINITY)
        return std::nullopt;
    return chosen->view;
}

}  // namespace drtv::picture
