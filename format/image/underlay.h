// A picture of the map from above, to lie under probes.
#pragma once

#include "image/png.h"

#include <array>
#include <cstdint>
#include <string>

namespace drtv::image {

class Underlay {
  public:
    // A PNG that says which part of the world it shows, as `bakerd render --top`, `drtv preview` and `bake
    // plan
    // --png` make them. Fails where it is none.
    [[nodiscard]] static cli::Result<Underlay> read(const std::string& path);

    // The three bytes at a place in metres; null outside.
    [[nodiscard]] const std::uint8_t* at(double x_m, double y_m) const;

  private:
    Underlay(Image image, const std::array<double, 4>& world) : image_(std::move(image)), world_(world) {}

    Image image_;
    std::array<double, 4> world_;  // x0, y0, x1, y1
};

}  // namespace drtv::image
