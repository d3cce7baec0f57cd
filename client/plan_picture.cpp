#include "client/plan_picture.h"

#include "client/canvas.h"
#include "format/folder/whole_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace drtv::client {
namespace {

constexpr Colour background = {28, 30, 34};
constexpr Colour hit = {70, 120, 80};
constexpr Colour near_hit = {230, 190, 60};
constexpr Colour rebake = {205, 70, 60};
constexpr Colour change = {80, 170, 255};

constexpr double sector_m = 64;

// In pixels.
constexpr int max_side = 2048;
constexpr int max_sector = 32;
constexpr int min_gapped_sector = 8;  // smaller ones touch
constexpr int min_mark = 5;           // of something that changed

Colour colour_of(v1::PlannedSector::Verdict verdict) {
    if (verdict == v1::PlannedSector::HIT)
        return hit;
    return verdict == v1::PlannedSector::NEAR_HIT ? near_hit : rebake;
}

// The sectors of a plan, and how many pixels each of them has along its side.
struct Layout {
    int west;
    int east;
    int south;
    int north;
    int side;

    [[nodiscard]] int columns() const { return east - west + 1; }
    [[nodiscard]] int rows() const { return north - south + 1; }
    [[nodiscard]] double per_metre() const { return side / sector_m; }

    // In pixels, from the top left.
    [[nodiscard]] double x_of(double x_m) const {
        const double west_m = west * sector_m;
        return (x_m - west_m) * per_metre();
    }
    [[nodiscard]] double y_of(double y_m) const {
        const double north_m = (north + 1) * sector_m;
        return (north_m - y_m) * per_metre();
    }
};

// REQUIRES: the plan has sectors.
Layout layout_of(const v1::Plan& plan) {
    const v1::PlannedSector& first = plan.sectors(0);
    Layout layout{first.i(), first.i(), first.j(), first.j(), 0};
    for (const v1::PlannedSector& sector : plan.sectors()) {
        layout.west = std::min(layout.west, sector.i());
        layout.east = std::max(layout.east, sector.i());
        layout.south = std::min(layout.south, sector.j());
        layout.north = std::max(layout.north, sector.j());
    }
    const int longest = std::max(layout.columns(), layout.rows());
    layout.side = std::clamp(max_side / longest, 1, max_sector);
    return layout;
}

PixelRect place_of(const v1::PlannedSector& sector, const Layout& layout) {
    const int x = (sector.i() - layout.west) * layout.side;
    const int y = (layout.north - sector.j()) * layout.side;
    const int gap = layout.side >= min_gapped_sector ? 1 : 0;
    const int filled = layout.side - gap;
    return {x, y, x + filled, y + filled};
}

int pixel_before(double place) {
    return static_cast<int>(std::floor(place));
}

int pixel_after(double place) {
    return static_cast<int>(std::ceil(place));
}

// Large enough to be seen.
PixelRect mark_of(const v1::MapChange& changed, const Layout& layout) {
    const int x0 = pixel_before(layout.x_of(changed.x0()));
    const int x1 = pixel_after(layout.x_of(changed.x1()));
    const int y0 = pixel_before(layout.y_of(changed.y1()));
    const int y1 = pixel_after(layout.y_of(changed.y0()));
    const int wider = std::max(0, min_mark - (x1 - x0)) / 2;
    const int taller = std::max(0, min_mark - (y1 - y0)) / 2;
    return {x0 - wider, y0 - taller, x1 + wider, y1 + taller};
}

}  // namespace

cli::Result<void> write_plan_picture(const v1::Plan& plan, const std::string& path) {
    if (plan.sectors().empty())
        return cli::fail(cli::exit_invalid, "the plan has no sectors, so there is nothing to draw");
    const Layout layout = layout_of(plan);
    Canvas canvas(layout.columns() * layout.side, layout.rows() * layout.side, background);
    for (const v1::PlannedSector& sector : plan.sectors())
        canvas.fill(place_of(sector, layout), colour_of(sector.verdict()));
    for (const v1::MapChange& changed : plan.changes())
        canvas.frame(mark_of(changed, layout), change);
    const auto png = canvas.png();
    if (!png)
        return tl::unexpected(png.error());
    return folder::write_whole(path, *png);
}

}  // namespace drtv::client
