#include "bakerd/picture/compare.h"

#include "bakerd/bake/path.h"
#include "bakerd/picture/compare_figures.h"
#include "bakerd/picture/film.h"
#include "bakerd/picture/painter.h"
#include "bakerd/picture/path_light.h"
#include "bakerd/picture/probe_mix.h"
#include "bakerd/trace/device.h"
#include "format/kit/progress_bar.h"

#include <tbb/parallel_for.h>
#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <vector>

namespace drtv::picture {
namespace {

constexpr std::uint32_t probe_paths = 4096;
// Of the pixels along each axis that are asked for the true colours at their own place.
constexpr std::size_t place_step = 4;

// Of two independent guesses at the truth: their noise has no part in the mean of the product.
struct Truth {
    PathParts first, second;

    [[nodiscard]] glm::vec3 mean(Show show) const {
        return (picture::part_of(first, show) + picture::part_of(second, show)) / 2.0f;
    }
};

class Comparing {
  public:
    Comparing(const Setting& setting, const Moment& moment, const CompareSettings& settings, float exposure)
        : setting_(setting),
          moment_(moment),
          exposure_(exposure),
          size_(setting.camera().size()),
          path_light_(setting.scenery(), moment, setting.bake()),
          half_(std::max(settings.paths / 2, 1u), path_light_.dimensions()),
          picture_(3 * size_.width, size_.height),
          bar_("rows traced", size_.height) {}

    Comparison run() {
        find_true_colours();
        std::vector<CompareFigures> rows(size_.height);
        std::atomic<std::size_t> done = 0;
        for_each(size_.height, [&](std::size_t y) {
            for (std::size_t x = 0; x < size_.width; ++x)
                compare(x, y, rows[y]);
            bar_.show(++done);
        });
        CompareFigures figures;
        for (const CompareFigures& row : rows)
            figures.add(row);
        return {std::move(picture_), table_of(figures, shown())};
    }

  private:
    template <class Use>
    static void for_each(std::size_t count, const Use& use) {
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t n) {
            const trace::FloatMode float_mode;
            use(n);
        });
    }

    [[nodiscard]] glm::vec2 middle(std::size_t x, std::size_t y) const { return glm::vec2(x, y) + 0.5f; }

    [[nodiscard]] std::optional<SurfacePoint> point_at(std::size_t x, std::size_t y) const {
        const Camera& camera = setting_.camera();
        return surface_on(setting_.scenery().scene(), camera, camera.ray(middle(x, y)));
    }

    // Of all probes that light a pixel.
    void find_true_colours() {
        std::vector<std::atomic<const LoadedSector*>> sector_of(moment_.set().limits().probes);
        for_each(size_.height, [&](std::size_t y) {
            for (std::size_t x = 0; x < size_.width; ++x) {
                const auto point = point_at(x, y);
                if (!point)
                    continue;
                const ProbeMix mix = mix_at(moment_, point->at, point->hit.normal);
                for (std::size_t n = 0; n < mix.count; ++n)
                    sector_of[number_of(mix.probes[n])] = mix.probes[n].sector;
            }
        });
        true_colours_.resize(sector_of.size());
        const bake::SampleTable paths(probe_paths, path_light_.dimensions());
        for_each(sector_of.size(), [&](std::size_t n) {
            const LoadedSector* sector = sector_of[n];
            if (sector == nullptr)
                return;
            const glm::vec3 place = as_vec(position_m(sector->view, n - sector->first_probe));
            const glm::ivec3 seed(static_cast<int>(n), -1, 0);
            true_colours_[n] = colours_of(path_light_.at_basis(place, paths, seed), shown());
        });
    }

    static std::size_t number_of(const ProbeShare& probe) {
        return std::size_t{probe.sector->first_probe} + probe.probe;
    }

    // The part that is compared; all of the ambient light in a picture of the whole scene.
    [[nodiscard]] Show shown() const {
        return setting_.show() == Show::all ? Show::ambient : setting_.show();
    }

    [[nodiscard]] Truth truth_at(const glm::vec3& place,
                                 const glm::vec3& normal,
                                 std::size_t x,
                                 std::size_t y) const {
        const glm::ivec3 seed(static_cast<int>(x), static_cast<int>(y), 1);
        return {path_light_.at_normal(place, normal, half_, seed),
                path_light_.at_normal(place, normal, half_, seed + glm::ivec3(0, 0, 1))};
    }

    // Light at a normal of the probes that the runtime blends, each with its true colours.
    [[nodiscard]] glm::vec3 with_true_colours(const SurfacePoint& point, const glm::vec3& normal) const {
        const ProbeMix mix = mix_at(moment_, point.at, normal);
        glm::vec3 sum(0);
        for (std::size_t n = 0; n < mix.count; ++n)
            sum += shade(true_colours_[number_of(mix.probes[n])], normal) * mix.probes[n].share;
        if (mix.fallback > 0) {
            const Double3 asked = as_place(asked_place(point.at, normal));
            sum += shade(clamped(open_sky(moment_.light())), normal) *
                   (mix.fallback * moment_.set().sky_factor(asked));
        }
        return sum;
    }

    [[nodiscard]] glm::vec3 shade(const BasisColours& colours, const glm::vec3& normal) const {
        return as_vec(shade_ambient(moment_.light().mode, colours, as_float3(normal)));
    }

    void compare(std::size_t x, std::size_t y, CompareFigures& figures) {
        const auto point = point_at(x, y);
        std::array<glm::vec3, 3> light{};
        if (!point) {
            if (setting_.show() == Show::all)
                light.fill(moment_.sky(setting_.camera().ray(middle(x, y)).direction, true));
        } else if (!point->surface.absorbs) {
            light = lights_of(*point, x, y, figures);
        }
        for (std::size_t n = 0; n < light.size(); ++n)
            put_pixel(picture_, n * size_.width + x, y, filmic(light[n] * exposure_));
    }

    // Relit, true, and with true colours.
    std::array<glm::vec3, 3> lights_of(const SurfacePoint& point,
                                       std::size_t x,
                                       std::size_t y,
                                       CompareFigures& figures) {
        const glm::vec3& normal = point.hit.normal;
        const std::optional<glm::vec3> start = bake::before_surface(point.ray, point.hit);
        if (!start)
            return {};
        const Ambient ambient = moment_.ambient(point.at, normal);
        const Truth truth = truth_at(*start, normal, x, y);
        const glm::vec3 by_truth = with_true_colours(point, normal);
        note(figures, ambient, truth, by_truth);
        if (x % place_step == 0 && y % place_step == 0)
            note_place(figures, *start, normal, truth, by_truth, {x, y, 3});
        std::array<glm::vec3, 3> light = {picture::part_of(ambient, shown()), truth.mean(shown()), by_truth};
        if (setting_.show() != Show::all)
            return light;
        const glm::vec3 direct = direct_light(setting_.scenery(), moment_, point);
        for (glm::vec3& colour : light)
            colour = colour * point.surface.albedo + direct;
        if (point.surface.transmitted != glm::vec3(0))
            add_back(light, point, x, y);
        for (glm::vec3& colour : light)
            colour *= point.tint;
        return light;
    }

    // What leaves let through from their other side.
    void add_back(std::array<glm::vec3, 3>& light,
                  const SurfacePoint& point,
                  std::size_t x,
                  std::size_t y) const {
        const glm::vec3 normal = -point.hit.normal;
        const glm::vec3& through = point.surface.transmitted;
        const auto start = bake::beyond_surface(setting_.scenery().scene(), point.ray, point.hit);
        if (!start)
            return;
        light[0] += through * as_vec(moment_.ambient(point.at, normal).colour);
        light[1] += through * truth_at(*start, normal, x, y + size_.height).mean(Show::ambient);
        light[2] += through * with_true_colours(point, normal);
    }

    void note(CompareFigures& figures,
              const Ambient& ambient,
              const Truth& truth,
              const glm::vec3& by_truth) const {
        for (std::size_t n = 0; n < compared_parts.size(); ++n) {
            const glm::vec3 found = picture::part_of(ambient, compared_parts[n]);
            figures.by_part[n].add(found,
                                   found,
                                   picture::part_of(truth.first, compared_parts[n]),
                                   picture::part_of(truth.second, compared_parts[n]));
        }
        const glm::vec3 found = picture::part_of(ambient, shown());
        figures.shown.add(
            found, found, picture::part_of(truth.first, shown()), picture::part_of(truth.second, shown()));
        figures.storage.add(found, found, by_truth, by_truth);
    }

    void note_place(CompareFigures& figures,
                    const glm::vec3& place,
                    const glm::vec3& normal,
                    const Truth& truth,
                    const glm::vec3& by_truth,
                    const glm::ivec3& seed) const {
        const auto shaded = [&](const glm::ivec3& key) {
            return shade(colours_of(path_light_.at_basis(place, half_, key), shown()), normal);
        };
        const glm::vec3 first = shaded(seed);
        const glm::vec3 second = shaded(seed + glm::ivec3(0, 0, 1));
        figures.interpolation.add(by_truth, by_truth, first, second);
        figures.shading.add(
            first, second, picture::part_of(truth.first, shown()), picture::part_of(truth.second, shown()));
    }

    const Setting& setting_;
    const Moment& moment_;
    const float exposure_;
    const Size size_;
    const PathLight path_light_;
    const bake::SampleTable half_;
    std::vector<BasisColours> true_colours_;  // by number of the probe
    kit::Image picture_;
    kit::ProgressBar bar_;
};

}  // namespace

Comparison compare_with_paths(const Setting& setting,
                              const Moment& moment,
                              const CompareSettings& settings,
                              float exposure) {
    return Comparing(setting, moment, settings, exposure).run();
}

}  // namespace drtv::picture
