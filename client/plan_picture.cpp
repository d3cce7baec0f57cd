#include "client/plan_picture.h"

#include "client/map_files.h"

#include <fmt/format.h>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace drtv::client {
namespace {

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour background = {28, 30, 34}, hit = {70, 120, 80}, near_hit = {230, 190, 60},
                 rebake = {205, 70, 60}, change = {80, 170, 255};

constexpr double sector_m = 64;
constexpr int largest_side = 2048, largest_sector = 32;  // pixels
constexpr int least_mark = 5;                            // of something that changed

struct Canvas {
    int width, height;
    std::vector<std::uint8_t> rgb;

    Canvas(int w, int h) : width(w), height(h) {
        for (int n = 0; n < w * h; ++n)
            rgb.insert(rgb.end(), background.begin(), background.end());
    }
    void dot(int x, int y, const Colour& colour) {
        if (x < 0 || y < 0 || x >= width || y >= height)
            return;
        std::ranges::copy(colour, rgb.begin() + (std::ptrdiff_t{y} * width + x) * 3);
    }
    void fill(int x0, int y0, int x1, int y1, const Colour& colour) {
        for (int y = y0; y < y1; ++y) {
            for (int x = x0; x < x1; ++x)
                dot(x, y, colour);
        }
    }
    void frame(int x0, int y0, int x1, int y1, const Colour& colour) {
        for (int x = x0; x <= x1; ++x)
            dot(x, y0, colour), dot(x, y1, colour);
        for (int y = y0; y <= y1; ++y)
            dot(x0, y, colour), dot(x1, y, colour);
    }
};

Colour colour_of(v1::PlannedSector::Verdict verdict) {
    if (verdict == v1::PlannedSector::HIT)
        return hit;
    return verdict == v1::PlannedSector::NEAR_HIT ? near_hit : rebake;
}

}  // namespace

tl::expected<void, std::string> write_plan_picture(const v1::Plan& plan, const std::string& path) {
    if (plan.sectors().empty())
        return tl::unexpected(std::string("the plan has no sectors, so there is nothing to draw"));
    const auto by_i = [](const v1::PlannedSector& a, const v1::PlannedSector& b) { return a.i() < b.i(); };
    const auto by_j = [](const v1::PlannedSector& a, const v1::PlannedSector& b) { return a.j() < b.j(); };
    const auto [west, east] = std::minmax_element(plan.sectors().begin(), plan.sectors().end(), by_i);
    const auto [south, north] = std::minmax_element(plan.sectors().begin(), plan.sectors().end(), by_j);
    const int columns = east->i() - west->i() + 1, rows = north->j() - south->j() + 1;
    const int side = std::clamp(largest_side / std::max(columns, rows), 1, largest_sector);
    Canvas canvas(columns * side, rows * side);
    for (const v1::PlannedSector& sector : plan.sectors()) {
        const int x = (sector.i() - west->i()) * side, y = (north->j() - sector.j()) * side,
                  gap = side >= 8 ? 1 : 0;
        canvas.fill(x, y, x + side - gap, y + side - gap, colour_of(sector.verdict()));
    }
    const double per_metre = side / sector_m, west_m = west->i() * sector_m,
                 north_m = (north->j() + 1) * sector_m;
    for (const v1::MapChange& changed : plan.changes()) {
        int x0 = static_cast<int>(std::floor((changed.x0() - west_m) * per_metre)),
            x1 = static_cast<int>(std::ceil((changed.x1() - west_m) * per_metre));
        int y0 = static_cast<int>(std::floor((north_m - changed.y1()) * per_metre)),
            y1 = static_cast<int>(std::ceil((north_m - changed.y0()) * per_metre));
        const int wider = std::max(0, least_mark - (x1 - x0)) / 2,
                  taller = std::max(0, least_mark - (y1 - y0)) / 2;
        canvas.frame(x0 - wider, y0 - taller, x1 + wider, y1 + taller, change);
    }
    std::string png;
    const auto collect = [](void* context, void* data, int size) {
        static_cast<std::string*>(context)->append(static_cast<const char*>(data),
                                                   static_cast<std::size_t>(size));
    };
    if (stbi_write_png_to_func(
            collect, &png, canvas.width, canvas.height, 3, canvas.rgb.data(), canvas.width * 3) == 0)
        return tl::unexpected(std::string("the picture could not be encoded"));
    return write_whole(path, png);
}

}  // namespace drtv::client
