#include "region_picture.h"

#include "commands.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace drtv::tool {
namespace {

constexpr double spacing_m = 8;            // typical distance between probes, the width of a bucket
constexpr double background_reach_m = 12;  // a pixel farther than this from every probe stays empty
constexpr double dot_radius_m = 2.1;
constexpr Float3 empty_colour = {0.012f, 0.014f, 0.02f};

constexpr std::size_t max_covered_sectors = std::size_t{1} << 18;

struct Extent {
    int i0, j0, i1, j1;  // sectors, half open
    double metres_per_pixel;
    std::size_t width, height;

    // World position of a pixel's centre; rows run from the north (large y) down.
    [[nodiscard]] double x_m(std::size_t px) const {
        return i0 * sector_size_m + (static_cast<double>(px) + 0.5) * metres_per_pixel;
    }
    [[nodiscard]] double y_m(std::size_t py) const {
        return j1 * sector_size_m - (static_cast<double>(py) + 0.5) * metres_per_pixel;
    }
};

Extent measure(const RegionPicture& picture, double metres_per_pixel) {
    const auto [i, j] = picture.sectors.front();
    Extent e{i, j, i + 1, j + 1, metres_per_pixel, 0, 0};
    for (const auto& [si, sj] : picture.sectors) {
        e.i0 = std::min(e.i0, si);
        e.j0 = std::min(e.j0, sj);
        e.i1 = std::max(e.i1, si + 1);
        e.j1 = std::max(e.j1, sj + 1);
    }
    const double side_m = std::max(e.i1 - e.i0, e.j1 - e.j0) * double{sector_size_m};
    // However far apart the sectors lie, the picture stays under 64 megapixels.
    if (metres_per_pixel <= 0)
        e.metres_per_pixel = side_m / 1600;
    e.metres_per_pixel = std::max(e.metres_per_pixel, side_m / 8000);
    e.width = static_cast<std::size_t>(
        std::max(1.0, std::round((e.i1 - e.i0) * sector_size_m / e.metres_per_pixel)));
    e.height = static_cast<std::size_t>(
        std::max(1.0, std::round((e.j1 - e.j0) * sector_size_m / e.metres_per_pixel)));
    return e;
}

// Probes by 8 m squares, so that a pixel looks at its surroundings only.
class Buckets {
  public:
    Buckets(const Extent& extent, const std::vector<Dot>& dots)
        : extent_(extent),
          columns_(static_cast<std::size_t>(extent.i1 - extent.i0) * 8),
          rows_(static_cast<std::size_t>(extent.j1 - extent.j0) * 8) {
        buckets_.resize(columns_ * rows_);
        for (const Dot& dot : dots) {
            const std::size_t column = std::min(column_of(dot.x_m), columns_ - 1),
                              row = std::min(row_of(dot.y_m), rows_ - 1);
            buckets_[row * columns_ + column].push_back(&dot);
        }
    }

    template <class Visit>
    void visit_near(double x_m, double y_m, Visit visit) const {
        const std::size_t c = column_of(x_m), r = row_of(y_m);
        for (std::size_t row = r - std::min<std::size_t>(r, 2); row <= std::min(r + 2, rows_ - 1); ++row) {
            for (std::size_t column = c - std::min<std::size_t>(c, 2);
                 column <= std::min(c + 2, columns_ - 1);
                 ++column) {
                for (const Dot* dot : buckets_[row * columns_ + column])
                    visit(*dot);
            }
        }
    }

  private:
    [[nodiscard]] std::size_t column_of(double x_m) const {
        return static_cast<std::size_t>(std::max(0.0, (x_m - extent_.i0 * sector_size_m) / spacing_m));
    }
    [[nodiscard]] std::size_t row_of(double y_m) const {
        return static_cast<std::size_t>(std::max(0.0, (y_m - extent_.j0 * sector_size_m) / spacing_m));
    }

    const Extent& extent_;
    std::size_t columns_, rows_;
    std::vector<std::vector<const Dot*>> buckets_;
};

struct Ground {
    float weight = 0, height_m = 0, sky_visibility = 0;
};

// Smooth interpolation between the probes around, on the side of the higher ones: what is seen from above.
Ground ground_at(const Buckets& buckets, double x_m, double y_m) {
    double weight_sum = 0, height_sum = 0, visibility_sum = 0,
           nearest = background_reach_m * background_reach_m;
    buckets.visit_near(x_m, y_m, [&](const Dot& dot) {
        const double dx = dot.x_m - x_m, dy = dot.y_m - y_m, d2 = dx * dx + dy * dy;
        nearest = std::min(nearest, d2);
        const double falloff = 1 / (1 + d2 / 50), weight = falloff * falloff * falloff;
        weight_sum += weight;
        height_sum += weight * dot.z_m;
        visibility_sum += weight * static_cast<double>(dot.sky_visibility);
    });
    if (nearest >= background_reach_m * background_reach_m)
        return {};
    return {static_cast<float>(weight_sum),
            static_cast<float>(height_sum / weight_sum),
            static_cast<float>(visibility_sum / weight_sum)};
}

std::uint8_t encode_srgb(float linear) {
    const float x = std::clamp(linear, 0.0f, 1.0f);
    const float s = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
    return static_cast<std::uint8_t>(s * 255 + 0.5f);
}

void put_pixel(Image& image, std::size_t x, std::size_t y, const Float3& linear) {
    for (std::size_t c = 0; c < 3; ++c)
        image.at(x, y)[c] = encode_srgb(linear[c]);
}

void draw_background(Image& image, const Extent& extent, const Buckets& buckets) {
    std::vector<Ground> ground(extent.width * extent.height);
    for (std::size_t y = 0; y < extent.height; ++y) {
        for (std::size_t x = 0; x < extent.width; ++x)
            ground[y * extent.width + x] = ground_at(buckets, extent.x_m(x), extent.y_m(y));
    }
    for (std::size_t y = 0; y < extent.height; ++y) {
        for (std::size_t x = 0; x < extent.width; ++x) {
            const Ground& here = ground[y * extent.width + x];
            if (here.weight <= 0) {
                put_pixel(image, x, y, empty_colour);
                continue;
            }
            const Ground& east = ground[y * extent.width + std::min(x + 1, extent.width - 1)];
            const Ground& south = ground[std::min(y + 1, extent.height - 1) * extent.width + x];
            const float run_m = static_cast<float>(extent.metres_per_pixel);
            const float slope_x = east.weight > 0 ? (east.height_m - here.height_m) / run_m : 0;
            const float slope_y = south.weight > 0 ? (here.height_m - south.height_m) / run_m : 0;
            // Lambert shading from the north-west, as relief maps are drawn.
            const float shade = std::max(0.0f,
                                         (0.5f * slope_x - 0.5f * slope_y + 0.8f) /
                                             std::sqrt(1 + slope_x * slope_x + slope_y * slope_y));
            const float grey = 0.22f * here.sky_visibility * here.sky_visibility * (0.15f + 0.85f * shade);
            put_pixel(image, x, y, {grey, grey, grey * 1.05f});
        }
    }
}

void draw_sector_lines(Image& image, const Extent& extent) {
    const auto darken = [&](std::size_t x, std::size_t y) {
        for (std::size_t c = 0; c < 3; ++c)
            image.at(x, y)[c] = static_cast<std::uint8_t>(image.at(x, y)[c] * 3 / 4);
    };
    for (int i = 1; i < extent.i1 - extent.i0; ++i) {
        const auto x = static_cast<std::size_t>(i * sector_size_m / extent.metres_per_pixel);
        for (std::size_t y = 0; y < extent.height && x < extent.width; ++y)
            darken(x, y);
    }
    for (int j = 1; j < extent.j1 - extent.j0; ++j) {
        const auto y = static_cast<std::size_t>(j * sector_size_m / extent.metres_per_pixel);
        for (std::size_t x = 0; x < extent.width && y < extent.height; ++x)
            darken(x, y);
    }
}

void draw_dots(Image& image, const Extent& extent, std::vector<Dot> dots) {
    // Higher probes over lower ones, as seen from above.
    std::stable_sort(dots.begin(), dots.end(), [](const Dot& a, const Dot& b) { return a.z_m < b.z_m; });
    for (const Dot& dot : dots) {
        const double radius_px = std::max(1.3, dot_radius_m / extent.metres_per_pixel);
        const double cx = (dot.x_m - extent.i0 * sector_size_m) / extent.metres_per_pixel;
        const double cy = (extent.j1 * sector_size_m - dot.y_m) / extent.metres_per_pixel;
        const auto low = [](double v) { return static_cast<std::size_t>(std::max(0.0, std::floor(v))); };
        for (std::size_t y = low(cy - radius_px); y <= low(cy + radius_px) && y < extent.height; ++y) {
            for (std::size_t x = low(cx - radius_px); x <= low(cx + radius_px) && x < extent.width; ++x) {
                const double dx = static_cast<double>(x) + 0.5 - cx, dy = static_cast<double>(y) + 0.5 - cy;
                const double d = std::sqrt(dx * dx + dy * dy);
                if (d > radius_px)
                    continue;
                // Hand-placed probes have a white rim.
                const bool rim = dot.kind == ProbeKind::manual && d > radius_px - 1;
                put_pixel(image, x, y, rim ? Float3{1, 1, 1} : dot.colour);
            }
        }
    }
}

}  // namespace

void RegionPicture::add(const Sector& sector, const std::function<Float3(std::size_t, float)>& colour) {
    sectors.push_back({sector.i, sector.j});
    for (std::size_t n = 0; n < sector.probes.size(); ++n) {
        const Probe& probe = sector.probes[n];
        const Float3 p = position_m(sector, probe);
        Dot dot{p[0], p[1], p[2], 0, probe.kind, {}};
        for (std::size_t b = 0; b < 3; ++b)
            dot.sky_visibility += decode_fixed(probe.sky_visibility[b], sky_visibility_scale) / 3;
        dot.colour = colour(n, dot.sky_visibility);
        dots.push_back(dot);
    }
}

std::optional<Image> draw(const RegionPicture& picture, double metres_per_pixel) {
    const Extent extent = measure(picture, metres_per_pixel);
    const std::size_t covered =
        static_cast<std::size_t>(extent.i1 - extent.i0) * static_cast<std::size_t>(extent.j1 - extent.j0);
    if (covered > max_covered_sectors) {
        complain("the sectors lie too far apart for one picture: the rectangle around them has " +
                 std::to_string(covered) + " sectors, the limit is " + std::to_string(max_covered_sectors));
        return std::nullopt;
    }
    Image image(extent.width, extent.height);
    draw_background(image, extent, Buckets(extent, picture.dots));
    draw_sector_lines(image, extent);
    draw_dots(image, extent, picture.dots);
    return image;
}

}  // namespace drtv::tool
