#include "region_picture.h"

#include "ground_map.h"
#include "kit/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace drtv::tool {
namespace {

constexpr double dot_radius_m = 2.1;
constexpr Float3 empty_colour = {0.012f, 0.014f, 0.02f};

using Pixel = image::Colour;

Pixel encode_pixel(const Float3& linear) {
    return {kit::encode_srgb(linear[0]), kit::encode_srgb(linear[1]), kit::encode_srgb(linear[2])};
}

void put_pixel(image::Image& image, std::size_t x, std::size_t y, const Pixel& pixel) {
    std::ranges::copy(pixel, image.at(x, y));
}

// REQUIRES: there is ground.
Float3 ground_colour(const GroundRows& ground, std::size_t x) {
    const Ground& here = ground.at(x);
    const float lit = 0.15f + 0.85f * ground.shade(x);
    const float grey = 0.22f * here.sky_visibility * here.sky_visibility * lit;
    return {grey, grey, grey * 1.05f};
}

void draw_background(image::Image& image,
                     const image::MapExtent& extent,
                     const std::vector<Dot>& dots,
                     const image::Underlay* under) {
    const Pixel empty = encode_pixel(empty_colour);
    GroundRows ground(extent, dots);
    for (std::size_t y = 0; y < image.height; ++y, ground.next_row()) {
        for (std::size_t x = 0; x < image.width; ++x) {
            const std::uint8_t* lying = under != nullptr ? under->at(extent.x_m(x), extent.y_m(y)) : nullptr;
            if (lying != nullptr) {
                put_pixel(image, x, y, {lying[0], lying[1], lying[2]});
                continue;
            }
            const bool has_ground = ground.at(x).weight > 0;
            const Pixel pixel = has_ground ? encode_pixel(ground_colour(ground, x)) : empty;
            put_pixel(image, x, y, pixel);
        }
    }
}

void darken_pixel(image::Image& image, std::size_t x, std::size_t y) {
    std::uint8_t* pixel = image.at(x, y);
    for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = static_cast<std::uint8_t>(pixel[c] * 3 / 4);
}

void darken_column(image::Image& image, std::size_t x) {
    if (x >= image.width)
        return;
    for (std::size_t y = 0; y < image.height; ++y)
        darken_pixel(image, x, y);
}

void darken_row(image::Image& image, std::size_t y) {
    if (y >= image.height)
        return;
    for (std::size_t x = 0; x < image.width; ++x)
        darken_pixel(image, x, y);
}

// None where they would leave nothing else.
void draw_sector_lines(image::Image& image, const image::MapExtent& extent) {
    constexpr double min_sector_px = 8;
    if (sector_size_m / extent.metres_per_pixel < min_sector_px)
        return;
    const auto pixel_of = [&](std::size_t sectors) {
        const double metres = static_cast<double>(sectors) * sector_size_m;
        return static_cast<std::size_t>(metres / extent.metres_per_pixel);
    };
    for (std::size_t i = 1; i < extent.sectors_wide(); ++i)
        darken_column(image, pixel_of(i));
    for (std::size_t j = 1; j < extent.sectors_high(); ++j)
        darken_row(image, pixel_of(j));
}

struct PixelRange {
    std::size_t first;
    std::size_t end;
};

// What `radius` around `centre` touches, within `size`.
PixelRange pixels_around(double centre, double radius, std::size_t size) {
    const double low = std::floor(centre - radius);
    const double high = std::floor(centre + radius);
    const auto first = static_cast<std::size_t>(std::max(0.0, low));
    const auto last = static_cast<std::size_t>(std::max(0.0, high));
    return {first, std::min(last + 1, size)};
}

void draw_dot(image::Image& image, const image::MapExtent& extent, const Dot& dot) {
    constexpr Pixel white = {255, 255, 255};
    const Pixel colour = encode_pixel(dot.colour);
    const double radius_px = std::max(1.3, dot_radius_m / extent.metres_per_pixel);
    const double centre_x = extent.x_px(dot.x_m);
    const double centre_y = extent.y_px(dot.y_m);
    const PixelRange columns = pixels_around(centre_x, radius_px, image.width);
    const PixelRange rows = pixels_around(centre_y, radius_px, image.height);
    for (std::size_t y = rows.first; y < rows.end; ++y) {
        for (std::size_t x = columns.first; x < columns.end; ++x) {
            const double dx = static_cast<double>(x) + 0.5 - centre_x;
            const double dy = static_cast<double>(y) + 0.5 - centre_y;
            const double distance_px = std::sqrt(dx * dx + dy * dy);
            if (distance_px > radius_px)
                continue;
            // Hand-placed probes have a white rim.
            const bool rim = dot.kind == ProbeKind::manual && distance_px > radius_px - 1;
            put_pixel(image, x, y, rim ? white : colour);
        }
    }
}

// Higher probes over lower ones, as seen from above.
void draw_dots(image::Image& image, const image::MapExtent& extent, std::vector<Dot> dots) {
    std::ranges::stable_sort(dots, {}, &Dot::z_m);
    for (const Dot& dot : dots)
        draw_dot(image, extent, dot);
}

}  // namespace

void RegionPicture::add(const Sector& sector, const DotColour& colour) {
    sectors.push_back({sector.i, sector.j});
    for (std::size_t p = 0; p < sector.probes.size(); ++p) {
        const Probe& probe = sector.probes[p];
        const auto [x, y, z] = position_m(sector, probe);
        Dot dot{x, y, z, 0, probe.kind, {}};
        for (std::size_t b = 0; b < 3; ++b)
            dot.sky_visibility += decode_fixed(probe.sky_visibility[b], sky_visibility_scale) / 3;
        dot.colour = colour(sector, p, dot.sky_visibility);
        dots.push_back(dot);
    }
}

void RegionPicture::scale_colours() {
    std::vector<float> lit;
    for (const Dot& dot : dots) {
        const float brightest = *std::ranges::max_element(dot.colour);
        if (brightest > 0)
            lit.push_back(brightest);
    }
    if (lit.empty()) {
        title += "; there is none";
        return;
    }
    std::ranges::sort(lit);
    const float white = lit[lit.size() - 1 - lit.size() / 50];
    for (Dot& dot : dots) {
        for (float& channel : dot.colour)
            channel /= white;
    }
    std::array<char, 64> text{};
    std::snprintf(
        text.data(), text.size(), "white: irradiance / pi of %.3g W/m2", static_cast<double>(white));
    legend.insert(legend.begin(), {{1, 1, 1}, text.data()});
}

DrawnRegion draw(const RegionPicture& picture, double metres_per_pixel, const image::Underlay* under) {
    const image::MapExtent extent = image::measure(picture.sectors, metres_per_pixel);
    image::Image map(extent.width, extent.height);
    draw_background(map, extent, picture.dots, under);
    draw_sector_lines(map, extent);
    draw_dots(map, extent, picture.dots);
    image::SheetText text{picture.title, {}};
    for (const ColourMeaning& meaning : picture.legend)
        text.legend.push_back({encode_pixel(meaning.colour), meaning.text});
    if (under == nullptr)
        text.legend.push_back({{90, 90, 93}, "ground: shaded, darker under less sky"});
    return {framed(map, extent, text), extent.note};
}

}  // namespace drtv::tool
