// A picture to draw on: pixels from the top left, what lies outside is cut off.
#pragma once

#include "format/cli/failure.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace drtv::client {

using Colour = std::array<std::uint8_t, 3>;  // sRGB

struct PixelRect {
    int x0;
    int y0;
    int x1;
    int y1;
};

class Canvas {
  public:
    // REQUIRES: both are positive, and their product fits in an int.
    Canvas(int width, int height, const Colour& background);

    // Without the pixels at x1 and y1.
    void fill(const PixelRect& rect, const Colour& colour);

    // One pixel wide, those at x1 and y1 included.
    void frame(const PixelRect& rect, const Colour& colour);

    // The bytes of a PNG file.
    [[nodiscard]] cli::Result<std::string> png() const;

  private:
    void dot(int x, int y, const Colour& colour);

    int width_;
    int height_;
    std::vector<std::uint8_t> rgb_;
};

}  // namespace drtv::client
