// The part of the world that a map from above shows, and where its pixels lie.
#pragma once

#include <drtv/conventions.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace drtv::image {

// A rectangle of whole sectors.
struct MapExtent {
    int i0;  // sectors, half open
    int j0;
    int i1;
    int j1;
    double metres_per_pixel;
    std::size_t width;  // pixels
    std::size_t height;
    std::string note;  // one sentence, where the scale is not the one that was asked for

    [[nodiscard]] std::size_t sectors_wide() const { return static_cast<std::size_t>(i1 - i0); }
    [[nodiscard]] std::size_t sectors_high() const { return static_cast<std::size_t>(j1 - j0); }

    // World position of a pixel's centre; rows run from the north (large y) down.
    [[nodiscard]] double x_m(std::size_t px) const {
        const double pixels = static_cast<double>(px) + 0.5;
        return i0 * sector_size_m + pixels * metres_per_pixel;
    }
    [[nodiscard]] double y_m(std::size_t py) const {
        const double pixels = static_cast<double>(py) + 0.5;
        return j1 * sector_size_m - pixels * metres_per_pixel;
    }

    // The inverse, in pixels.
    [[nodiscard]] double x_px(double x_m) const { return (x_m - i0 * sector_size_m) / metres_per_pixel; }
    [[nodiscard]] double y_px(double y_m) const { return (j1 * sector_size_m - y_m) / metres_per_pixel; }
};

// Around all sectors (i, j). At 0 metres a pixel the longer side has about 1,600 pixels. However far apart
// the sectors lie, no side has more than 7,168: with its frame (map_sheet.h) a picture has at most 8,192.
// REQUIRES: at least one sector.
[[nodiscard]] MapExtent measure(std::span<const std::array<std::int32_t, 2>> sectors,
                                double metres_per_pixel);

}  // namespace drtv::image
