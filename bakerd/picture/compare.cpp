#include "bakerd/picture/compare.h"

#include "bakerd/bake/path.h"
#include "bakerd/picture/compare_figures.h"
#include "bakerd/picture/film.h"
#include "bakerd/picture/painter.h"
#include "bakerd/picture/path_light.h"
#include "bakerd/picture/true_probes.h"
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

// Of the pixels along each axis that are asked for the true colours at their own place.
constexpr std::size_t place_step = 4;

class Comparing {
  public:
    Comparing(const Shot& shot, const Moment& moment, const CompareSettings& settings, float exposure)
        : shot_(shot),
          moment_(moment),
          exposure_(exposure),
          size_(shot.camera().size()),
          path_light_(shot.scenery(), moment, shot.bake()),
          half_(std::max(settings.paths / 2, 1u), path_light_.dimensions()),
          true_probes_(moment, path_light_, shown()),
          picture_(3 * size_.width, size_.height),
          bar_("rows traced", size_.height) {}

    Comparison run() {
        for_each_row([&](std::size_t y) {
            for (std::size_t x = 0; x < size_.width; ++x)
                ask_for_probes(x, y);
        });
        true_probes_.trace();
        std::vector<CompareFigures> rows(size_.height);
        std::atomic<std::size_t> done = 0;
        for_each_row([&](std::size_t y) {
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
    using Truth = Guesses<PathParts>;

    template <class Use>
    void for_each_row(const Use& use) const {
        tbb::parallel_for(std::size_t{0}, size_.height, [&](std::size_t y) {
            const trace::FloatMode float_mode;
            use(y);
        });
    }

    [[nodiscard]] trace::Ray ray_of(std::size_t x, std::size_t y) const {
        return shot_.camera().ray(glm::vec2(x, y) + 0.5f);
    }
    [[nodiscard]] std::optional<SurfacePoint> point_at(std::size_t x, std::size_t y) const {
        return surface_on(shot_.scenery().scene(), shot_.camera(), ray_of(x, y));
    }

    // The part that is compared; all of the ambient light in a picture of the whole scene.
    [[nodiscard]] Show shown() const { return shot_.show() == Show::all ? Show::ambient : shot_.show(); }
    [[nodiscard]] Guesses<glm::vec3> shown_of(const Truth& truth) const {
        return {picture::part_of(truth[0], shown()), picture::part_of(truth[1], shown())};
    }
    // Whether the light that comes through a surface from behind counts.
    [[nodiscard]] bool shows_back(const SurfacePoint& point) const {
        return shot_.show() == Show::all && point.surface.transmitted != glm::vec3(0);
    }

    void ask_for_probes(std::size_t x, std::size_t y) {
        const auto point = point_at(x, y);
        if (!point)
            return;
        true_probes_.ask_for(point->at, point->hit.normal);
        if (shows_back(*point))
            true_probes_.ask_for(point->at, -point->hit.normal);
    }

    [[nodiscard]] Truth truth_at(const glm::vec3& place,
                                 const glm::vec3& normal,
                                 std::size_t x,
                                 std::size_t y) const {
        const glm::ivec3 seed(static_cast<int>(x), static_cast<int>(y), 1);
        return {path_light_.at_normal(place, normal, half_, seed),
                path_light_.at_normal(place, normal, half_, seed + glm::ivec3(0, 0, 1))};
    }

    void compare(std::size_t x, std::size_t y, CompareFigures& figures) {
        const auto point = point_at(x, y);
        std::array<glm::vec3, 3> light{};
        if (!point) {
            if (shot_.show() == Show::all)
                light.fill(sky_seen(shot_.scenery(), moment_, ray_of(x, y), true));
        } else if (!point->surface.absorbs) {
            light = lights_of(*point, x, y, figures);
        }
        for (std::size_t n = 0; n < light.size(); ++n)
            put_pixel(picture_, n * size_.width + x, y, filmic(light[n] * exposure_));
    }

    // Relit, true, and with true colours at the probes.
    std::array<glm::vec3, 3> lights_of(const SurfacePoint& point,
                                       std::size_t x,
                                       std::size_t y,
                                       CompareFigures& figures) const {
        const glm::vec3& normal = point.hit.normal;
        const std::optional<glm::vec3> start = bake::before_surface(point.ray, point.hit);
        if (!start)
            return {};
        const Ambient ambient = moment_.ambient(point.at, normal);
        const Truth truth = truth_at(*start, normal, x, y);
        const Guesses<glm::vec3> by_probes = true_probes_.light(point.at, normal);
        note(figures, ambient, truth, by_probes);
        if (x % place_step == 0 && y % place_step == 0)
            note_place(figures, *start, normal, truth, by_probes, {x, y, 3});
        std::array<glm::vec3, 3> light = {
            picture::part_of(ambient, shown()), mean_of(shown_of(truth)), mean_of(by_probes)};
        if (shot_.show() != Show::all)
            return light;
        const glm::vec3 direct = direct_light(shot_.scenery(), moment_, point);
        for (glm::vec3& colour : light)
            colour = colour * point.surface.albedo + direct;
        if (shows_back(point))
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
        const auto start = bake::beyond_surface(shot_.scenery().scene(), point.ray, point.hit);
        if (!start)
            return;
        light[0] += through * moment_.ambient_colour(point.at, normal);
        light[1] += through * mean_of(shown_of(truth_at(*start, normal, x, y + size_.height)));
        light[2] += through * mean_of(true_probes_.light(point.at, normal));
    }

    void note(CompareFigures& figures,
              const Ambient& ambient,
              const Truth& truth,
              const Guesses<glm::vec3>& by_probes) const {
        for (std::size_t n = 0; n < compared_parts.size(); ++n) {
            const Show part = compared_parts[n];
            const glm::vec3 found = picture::part_of(ambient, part);
            figures.by_part[n].add({found, found},
                                   {picture::part_of(truth[0], part), picture::part_of(truth[1], part)});
        }
        const glm::vec3 found = picture::part_of(ambient, shown());
        figures.shown.add({found, found}, shown_of(truth));
        figures.storage.add({found, found}, by_probes);
    }

    void note_place(CompareFigures& figures,
                    const glm::vec3& place,
                    const glm::vec3& normal,
                    const Truth& truth,
                    const Guesses<glm::vec3>& by_probes,
                    const glm::ivec3& seed) const {
        const auto colours = [&](const glm::ivec3& key) {
            return colours_of(path_light_.at_basis(place, half_, key), shown());
        };
        const Guesses<glm::vec3> by_place = shaded(
            moment_.light().mode, shown(), {colours(seed), colours(seed + glm::ivec3(0, 0, 1))}, normal);
        figures.interpolation.add(by_probes, by_place);
        figures.shading.add(by_place, shown_of(truth));
    }

    const Shot& shot_;
    const Moment& moment_;
    const float exposure_;
    const Size size_;
    const PathLight path_light_;
    const bake::SampleTable half_;  // of the paths of a pixel
    TrueProbes true_probes_;
    image::Image picture_;
    kit::ProgressBar bar_;
};

}  // namespace

Comparison compare_with_paths(const Shot& shot,
                              const Moment& moment,
                              const CompareSettings& settings,
                              float exposure) {
    return Comparing(shot, moment, settings, exposure).run();
}

}  // namespace drtv::picture
