// Numbers and lines of a frame, as there is room for them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace drtv::image {

// The largest of 1, 2, 5, 10, 20 ... that is no larger. REQUIRES: the value is positive.
[[nodiscard]] double round_down(double value);

// "200 m", "5 km".
[[nodiscard]] std::string length_text(double metres);

// Every how many sectors a label has room that takes so many pixels.
[[nodiscard]] int label_step(double sector_px, int label_px);

// Lines of words, none wider than there is room, where words let it.
[[nodiscard]] std::vector<std::string> wrapped(std::string_view text, int width_px, int scale);

}  // namespace drtv::image
