// A line of text in a picture.
#pragma once

#include "format/kit/png.h"

#include <cstddef>
#include <string>

namespace drtv::picture {

// White on a dark bar, its upper left corner at (x, y); ASCII. What does not fit is cut.
void write_caption(kit::Image& image, std::size_t x, std::size_t y, const std::string& text);

}  // namespace drtv::picture
