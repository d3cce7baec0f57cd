#include "ground_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace drtv::tool {
namespace {

constexpr double reach_m = 12;        // a pixel farther than this from every probe stays empty
constexpr double min_square_m = 8;    // the typical distance between probes
constexpr double max_squares = 1024;  // along a side

}  // namespace

ProbeSquares::ProbeSquares(const image::MapExtent& extent, const std::vector<Dot>& dots)
    : x0_m_(extent.i0 * double{sector_size_m}), y0_m_(extent.j0 * double{sector_size_m}) {
    const double wide_m = static_cast<double>(extent.sectors_wide()) * double{sector_size_m};
    const double high_m = static_cast<double>(extent.sectors_high()) * double{sector_size_m};
    side_m_ = std::max(min_square_m, std::max(wide_m, high_m) / max_squares);
    reach_ = static_cast<std::size_t>(std::ceil(reach_m / side_m_));
    columns_ = static_cast<std::size_t>(std::ceil(wide_m / side_m_));
    rows_ = static_cast<std::size_t>(std::ceil(high_m / side_m_));
    squares_.resize(columns_ * rows_);
    for (const Dot& dot : dots)
        squares_[row_of(dot.y_m) * columns_ + column_of(dot.x_m)].push_back(&dot);
}

std::size_t ProbeSquares::column_of(double x_m) const {
    return std::min(static_cast<std::size_t>(std::max(0.0, (x_m - x0_m_) / side_m_)), columns_ - 1);
}

std::size_t ProbeSquares::row_of(double y_m) const {
    return std::min(static_cast<std::size_t>(std::max(0.0, (y_m - y0_m_) / side_m_)), rows_ - 1);
}

// Smooth interpolation between the probes around.
Ground ProbeSquares::ground_at(double x_m, double y_m) const {
    double weight_sum = 0;
    double height_sum = 0;
    double visibility_sum = 0;
    double nearest_m2 = reach_m * reach_m;
    const auto add = [&](const Dot& dot) {
        const double dx = dot.x_m - x_m;
        const double dy = dot.y_m - y_m;
        const double distance_m2 = dx * dx + dy * dy;
        nearest_m2 = std::min(nearest_m2, distance_m2);
        const double falloff = 1 / (1 + distance_m2 / 50);
        const double weight = falloff * falloff * falloff;
        weight_sum += weight;
        height_sum += weight * dot.z_m;
        visibility_sum += weight * static_cast<double>(dot.sky_visibility);
    };
    const std::size_t c = column_of(x_m);
    const std::size_t r = row_of(y_m);
    for (std::size_t row = r - std::min(r, reach_); row <= std::min(r + reach_, rows_ - 1); ++row) {
        for (std::size_t column = c - std::min(c, reach_); column <= std::min(c + reach_, columns_ - 1);
             ++column) {
            for (const Dot* dot : squares_[row * columns_ + column])
                add(*dot);
        }
    }
    if (nearest_m2 >= reach_m * reach_m)
        return {};
    return {static_cast<float>(weight_sum),
            static_cast<float>(height_sum / weight_sum),
            static_cast<float>(visibility_sum / weight_sum)};
}

GroundRows::GroundRows(const image::MapExtent& extent, const std::vector<Dot>& dots)
    : extent_(extent), squares_(extent, dots), here_(row(0)), south_(row(1)) {}

std::vector<Ground> GroundRows::row(std::size_t y) const {
    std::vector<Ground> row(extent_.width);
    const double y_m = extent_.y_m(std::min(y, extent_.height - 1));
    for (std::size_t x = 0; x < row.size(); ++x)
        row[x] = squares_.ground_at(extent_.x_m(x), y_m);
    return row;
}

void GroundRows::next_row() {
    ++y_;
    here_ = std::exchange(south_, row(y_ + 1));
}

const Ground& GroundRows::at(std::size_t x) const {
    return here_[std::min(x, here_.size() - 1)];
}

float GroundRows::shade(std::size_t x) const {
    const auto run_m = static_cast<float>(extent_.metres_per_pixel);
    const Ground& here = at(x);
    const Ground& east = at(x + 1);
    const Ground& south = south_[x];
    const float slope_x = east.weight > 0 ? (east.height_m - here.height_m) / run_m : 0;
    const float slope_y = south.weight > 0 ? (here.height_m - south.height_m) / run_m : 0;
    const float cosine = 0.5f * slope_x - 0.5f * slope_y + 0.8f;
    const float length = std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
    return std::max(0.0f, cosine / length);
}

}  // namespace drtv::tool
