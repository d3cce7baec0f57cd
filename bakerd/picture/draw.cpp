#include "bakerd/picture/draw.h"

#include "bakerd/map/colour.h"
#include "bakerd/picture/film.h"
#include "bakerd/trace/device.h"

#include <tbb/parallel_for.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <span>
#include <vector>

namespace drtv::picture {
namespace {

// Codes of 255 by which a pixel differs from a neighbour.
constexpr int edge = 12;
// A rotated square: no two lie in one row or column.
constexpr std::array<glm::vec2, 4> inside_pixel = {
    {{0.375f, 0.125f}, {0.875f, 0.375f}, {0.125f, 0.625f}, {0.625f, 0.875f}}};

class Drawing {
  public:
    Drawing(const Painter& painter, Size size, float exposure, const Progress& progress)
        : painter_(painter),
          size_(size),
          exposure_(exposure),
          progress_(progress),
          image_(size.width, size.height) {}

    image::Image run() {
        for_each_row([&](std::size_t y) {
            for (std::size_t x = 0; x < size_.width; ++x)
                put_pixel(image_, x, y, shown(middle(x, y)));
        });
        if (!painter_.is_light())
            return std::move(image_);
        image::Image smooth = image_;
        for_each_row([&](std::size_t y) {
            for (std::size_t x = 0; x < size_.width; ++x) {
                if (is_edge(x, y))
                    put_pixel(smooth, x, y, smoothed(x, y));
            }
        });
        return smooth;
    }

  private:
    template <class Use>
    void for_each_row(const Use& use) {
        tbb::parallel_for(std::size_t{0}, size_.height, [&](std::size_t y) {
            const trace::FloatMode float_mode;
            use(y);
            progress_(++done_);
        });
    }

    static glm::vec2 middle(std::size_t x, std::size_t y) {
        return glm::vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f;
    }

    // Linear, 0 to 1.
    glm::vec3 shown(glm::vec2 pixel) const {
        const glm::vec3 colour = painter_.colour(pixel);
        return painter_.is_light() ? filmic(colour * exposure_) : colour;
    }

    glm::vec3 smoothed(std::size_t x, std::size_t y) const {
        glm::vec3 sum(0);
        for (const glm::vec2& at : inside_pixel)
            sum += shown(middle(x, y) - 0.5f + at);
        return sum / static_cast<float>(inside_pixel.size());
    }

    bool is_edge(std::size_t x, std::size_t y) {
        return (x > 0 && differ(x, y, x - 1, y)) || (x + 1 < size_.width && differ(x, y, x + 1, y)) ||
               (y > 0 && differ(x, y, x, y - 1)) || (y + 1 < size_.height && differ(x, y, x, y + 1));
    }
    bool differ(std::size_t x, std::size_t y, std::size_t other_x, std::size_t other_y) {
        const std::uint8_t* a = image_.at(x, y);
        const std::uint8_t* b = image_.at(other_x, other_y);
        return std::abs(a[0] - b[0]) > edge || std::abs(a[1] - b[1]) > edge || std::abs(a[2] - b[2]) > edge;
    }

    const Painter& painter_;
    const Size size_;
    const float exposure_;
    const Progress& progress_;
    std::atomic<std::size_t> done_ = 0;
    image::Image image_;
};

}  // namespace

std::size_t draw_steps(Show show, Size size) {
    return is_light(show) ? 2 * size.height : size.height;
}

image::Image draw(const Painter& painter, Size size, float exposure, const Progress& progress) {
    return Drawing(painter, size, exposure, progress).run();
}

namespace {

constexpr std::size_t grid_columns = 64;
constexpr std::size_t grid_rows = 36;

// Calls use(n, pixel, point) for each surface that one of a grid of rays meets, of grid_columns x grid_rows.
template <class Use>
void for_each_surface(const Camera& camera, const trace::Scene& scene, const Use& use) {
    const glm::vec2 step =
        glm::vec2(camera.size().width, camera.size().height) / glm::vec2(grid_columns, grid_rows);
    tbb::parallel_for(std::size_t{0}, grid_columns * grid_rows, [&](std::size_t n) {
        const trace::FloatMode float_mode;
        const glm::vec2 pixel = (glm::vec2(n % grid_columns, n / grid_columns) + 0.5f) * step;
        if (const auto point = surface_on(scene, camera, camera.ray(pixel)))
            use(n, pixel, *point);
    });
}

}  // namespace

bool sees_anything(const Camera& camera, const trace::Scene& scene) {
    std::atomic<bool> sees = false;
    for_each_surface(camera, scene, [&](std::size_t, const glm::vec2&, const SurfacePoint&) { sees = true; });
    return sees;
}

std::optional<double> brightness_log2(const Painter& painter,
                                      const Camera& camera,
                                      const trace::Scene& scene) {
    std::array<float, grid_columns * grid_rows> luminances{};
    for_each_surface(camera, scene, [&](std::size_t n, const glm::vec2& pixel, const SurfacePoint& point) {
        luminances[n] = map::luminance(painter.colour(pixel)) / std::sqrt(painter.brightness_of(point));
    });
    // Many surfaces have next to nothing of one part of the light: a geometric mean would be next to nothing.
    const bool geometric = painter.shows_all();
    double sum = 0;
    std::size_t count = 0;
    for (const float luminance : luminances) {
        if (!(luminance > 0) || !std::isfinite(luminance))
            continue;
        const auto value = static_cast<double>(luminance);
        sum += geometric ? log2_of(value) : value;
        ++count;
    }
    if (count == 0)
        return std::nullopt;
    const double mean = sum / static_cast<double>(count);
    return geometric ? mean : log2_of(mean);
}

}  // namespace drtv::picture
