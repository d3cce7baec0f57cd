#include "client/plan_picture.h"

#include "client/number_text.h"
#include "format/cli/report.h"
#include "format/image/map_sheet.h"
#include "format/image/png_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace drtv::client {
namespace {

using image::Colour;
using image::PixelRect;

constexpr Colour background = {28, 30, 34};
constexpr Colour hit = {70, 120, 80};
constexpr Colour near_hit = {230, 190, 60};
constexpr Colour rebake = {205, 70, 60};
constexpr Colour change = {80, 170, 255};

constexpr double max_sector_px = 192;
constexpr int min_gapped_sector_px = 8;  // smaller ones touch
constexpr int min_mark_px = 5;           // of something that changed
constexpr float over_picture = 0.45f;    // how much of a colour covers what lies under it

Colour colour_of(v1::PlannedSector::Verdict verdict) {
    if (verdict == v1::PlannedSector::HIT)
        return hit;
    return verdict == v1::PlannedSector::NEAR_HIT ? near_hit : rebake;
}

image::MapExtent extent_of(const v1::Plan& plan) {
    std::vector<std::array<std::int32_t, 2>> sectors;
    for (const v1::PlannedSector& sector : plan.sectors())
        sectors.push_back({sector.i(), sector.j()});
    const image::MapExtent usual = image::measure(sectors, 0);
    return image::measure(sectors, std::max(usual.metres_per_pixel, sector_size_m / max_sector_px));
}

int pixel(double place) {
    return static_cast<int>(std::floor(place));
}

PixelRect place_of(const v1::PlannedSector& sector, const image::MapExtent& extent) {
    const int x0 = pixel(extent.x_px(sector.i() * sector_size_m));
    const int x1 = pixel(extent.x_px((sector.i() + 1) * sector_size_m));
    const int y0 = pixel(extent.y_px((sector.j() + 1) * sector_size_m));
    const int y1 = pixel(extent.y_px(sector.j() * sector_size_m));
    const int gap = x1 - x0 >= min_gapped_sector_px ? 1 : 0;
    return {x0, y0, std::max(x1 - gap, x0 + 1), std::max(y1 - gap, y0 + 1)};
}

// Large enough to be seen.
PixelRect mark_of(const v1::MapChange& changed, const image::MapExtent& extent) {
    const int x0 = pixel(extent.x_px(changed.x0()));
    const int x1 = pixel(extent.x_px(changed.x1())) + 1;
    const int y0 = pixel(extent.y_px(changed.y1()));
    const int y1 = pixel(extent.y_px(changed.y0())) + 1;
    const int wider = (std::max(0, min_mark_px - (x1 - x0)) + 1) / 2;
    const int taller = (std::max(0, min_mark_px - (y1 - y0)) + 1) / 2;
    return {x0 - wider, y0 - taller, x1 + wider, y1 + taller};
}

// Over what lies there; full where nothing does.
void draw_sector(const v1::PlannedSector& sector,
                 const image::MapExtent& extent,
                 const image::Underlay* under,
                 image::Image& map) {
    const PixelRect place = place_of(sector, extent);
    for (int y = place.y0; y < place.y1; ++y) {
        for (int x = place.x0; x < place.x1; ++x) {
            const double x_m = extent.x_m(static_cast<std::size_t>(x));
            const double y_m = extent.y_m(static_cast<std::size_t>(y));
            const bool covers = under != nullptr && under->at(x_m, y_m) != nullptr;
            const float share = covers ? over_picture : 1;
            image::blend(map, {x, y, x + 1, y + 1}, colour_of(sector.verdict()), share);
        }
    }
}

void draw_under(const image::Underlay& under, const image::MapExtent& extent, image::Image& map) {
    for (std::size_t y = 0; y < map.height; ++y) {
        for (std::size_t x = 0; x < map.width; ++x) {
            if (const std::uint8_t* lying = under.at(extent.x_m(x), extent.y_m(y)))
                std::copy_n(lying, 3, map.at(x, y));
        }
    }
}

std::int64_t count(const v1::Plan& plan, v1::PlannedSector::Verdict verdict) {
    return std::ranges::count(plan.sectors(), verdict, &v1::PlannedSector::verdict);
}

image::SheetText text_of(const v1::Plan& plan) {
    const auto entry = [&](v1::PlannedSector::Verdict verdict, const char* what) {
        return image::LegendEntry{colour_of(verdict),
                                  fmt::format("{} ({})", what, with_thousands(count(plan, verdict)))};
    };
    image::SheetText text{"what a bake would do, by sector",
                          {entry(v1::PlannedSector::HIT, "in the cache"),
                           entry(v1::PlannedSector::NEAR_HIT, "nearly the same"),
                           entry(v1::PlannedSector::REBAKE, "to bake")}};
    if (!plan.changes().empty())
        text.legend.push_back(
            {change, fmt::format("frame: changed ({})", with_thousands(plan.changes_size()))});
    return text;
}

}  // namespace

cli::Result<void> write_plan_picture(const v1::Plan& plan,
                                     const std::string& path,
                                     const image::Underlay* under) {
    if (plan.sectors().empty())
        return cli::fail(cli::exit_invalid, "the plan has no sectors, so there is nothing to draw");
    const image::MapExtent extent = extent_of(plan);
    image::Image map(extent.width, extent.height);
    const int width = static_cast<int>(map.width);
    const int height = static_cast<int>(map.height);
    image::fill(map, {0, 0, width, height}, background);
    if (under != nullptr)
        draw_under(*under, extent, map);
    // Several sectors may share a pixel: what matters most is seen.
    for (const auto verdict :
         {v1::PlannedSector::HIT, v1::PlannedSector::NEAR_HIT, v1::PlannedSector::REBAKE}) {
        for (const v1::PlannedSector& sector : plan.sectors()) {
            if (sector.verdict() == verdict)
                draw_sector(sector, extent, under, map);
        }
    }
    for (const v1::MapChange& changed : plan.changes())
        image::frame(map, mark_of(changed, extent), change);
    const image::MapSheet sheet = image::framed(map, extent, text_of(plan));
    return image::write_png_file(path, sheet.image, sheet.texts);
}

}  // namespace drtv::client
