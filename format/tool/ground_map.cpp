#include "ground_map.h"

#include <algorithm>
#include <cmath>

namespace drtv::tool {
namespace {

constexpr double spacing_m = 8;            // typical distance between probes, the width of a bucket
constexpr double background_reach_m = 12;  // a pixel farther than this from every probe stays empty

std::size_t subtract_down_to_0(std::size_t n, std::size_t margin) {
    return n - std::min(n, margin);
}

// Probes by 8 m squares, so that a pixel looks at its surroundings only.
class Buckets {
  public:
    Buckets(const MapExtent& extent, const std::vector<Dot>& dots)
        : extent_(extent), columns_(extent.sectors_wide() * 8), rows_(extent.sectors_high() * 8) {
        buckets_.resize(columns_ * rows_);
        for (const Dot& dot : dots) {
            const std::size_t column = std::min(column_of(dot.x_m), columns_ - 1);
            const std::size_t row = std::min(row_of(dot.y_m), rows_ - 1);
            buckets_[row * columns_ + column].push_back(&dot);
        }
    }

    template <class Visit>
    void visit_near(double x_m, double y_m, Visit visit) const {
        constexpr std::size_t reach = 2;
        const std::size_t c = column_of(x_m);
        const std::size_t r = row_of(y_m);
        const std::size_t last_column = std::min(c + reach, columns_ - 1);
        const std::size_t last_row = std::min(r + reach, rows_ - 1);
        for (std::size_t row = subtract_down_to_0(r, reach); row <= last_row; ++row) {
            for (std::size_t column = subtract_down_to_0(c, reach); column <= last_column; ++column) {
                for (const Dot* dot : buckets_[row * columns_ + column])
                    visit(*dot);
            }
        }
    }

  private:
    static std::size_t bucket_of(double offset_m) {
        return static_cast<std::size_t>(std::max(0.0, offset_m / spacing_m));
    }
    [[nodiscard]] std::size_t column_of(double x_m) const {
        return bucket_of(x_m - extent_.i0 * sector_size_m);
    }
    [[nodiscard]] std::size_t row_of(double y_m) const { return bucket_of(y_m - extent_.j0 * sector_size_m); }

    const MapExtent& extent_;
    std::size_t columns_;
    std::size_t rows_;
    std::vector<std::vector<const Dot*>> buckets_;
};

// Smooth interpolation between the probes around, on the side of the higher ones: what is seen from above.
Ground ground_at(const Buckets& buckets, double x_m, double y_m) {
    constexpr double reach_m2 = background_reach_m * background_reach_m;
    double weight_sum = 0;
    double height_sum = 0;
    double visibility_sum = 0;
    double nearest_m2 = reach_m2;
    buckets.visit_near(x_m, y_m, [&](const Dot& dot) {
        const double dx = dot.x_m - x_m;
        const double dy = dot.y_m - y_m;
        const double distance_m2 = dx * dx + dy * dy;
        nearest_m2 = std::min(nearest_m2, distance_m2);
        const double falloff = 1 / (1 + distance_m2 / 50);
        const double weight = falloff * falloff * falloff;
        weight_sum += weight;
        height_sum += weight * dot.z_m;
        visibility_sum += weight * static_cast<double>(dot.sky_visibility);
    });
    if (nearest_m2 >= reach_m2)
        return {};
    Ground ground;
    ground.weight = static_cast<float>(weight_sum);
    ground.height_m = static_cast<float>(height_sum / weight_sum);
    ground.sky_visibility = static_cast<float>(visibility_sum / weight_sum);
    return ground;
}

}  // namespace

GroundMap::GroundMap(const MapExtent& extent, const std::vector<Dot>& dots)
    : width_(extent.width), height_(extent.height), run_m_(static_cast<float>(extent.metres_per_pixel)) {
    const Buckets buckets(extent, dots);
    ground_.resize(width_ * height_);
    auto pixel = ground_.begin();
    for (std::size_t y = 0; y < height_; ++y) {
        const double y_m = extent.y_m(y);
        for (std::size_t x = 0; x < width_; ++x)
            *pixel++ = ground_at(buckets, extent.x_m(x), y_m);
    }
}

float GroundMap::shade(std::size_t x, std::size_t y) const {
    const Ground& here = at(x, y);
    const Ground& east = at(x + 1, y);
    const Ground& south = at(x, y + 1);
    const float slope_x = east.weight > 0 ? (east.height_m - here.height_m) / run_m_ : 0;
    const float slope_y = south.weight > 0 ? (here.height_m - south.height_m) / run_m_ : 0;
    const float cosine = 0.5f * slope_x - 0.5f * slope_y + 0.8f;
    const float length = std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
    return std::max(0.0f, cosine / length);
}

}  // namespace drtv::tool
