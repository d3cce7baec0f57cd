// A picture of the map from above, to lie under probes.
#pragma once

#include "image/png.h"

#include <array>
#include <cstdint>
#include <string>

namespace drtv::image {

class Underlay {
  public:
    // A PNG that says which part of the world it shows. Fails where it is none, and where the picture that is
    // to be drawn over it, at `target`, would replace it.
    [[nodiscard]] static cli::Result<Underlay> read(const std::string& path, const std::string& target = "");

    // The three bytes at a place in metres; null outside.
    [[nodiscard]] const std::uint8_t* at(double x_m, double y_m) const;

  private:
    using Rectangle = std::array<double, 4>;  // x0, y0, x1, y1

    Underlay(Image image, const Rectangle& world, const Rectangle& map)
        : image_(std::move(image)), world_(world), map_(map) {}

    Image image_;
    Rectangle world_;  // metres
    Rectangle map_;    // the pixels that show it
};

}  // namespace drtv::image
