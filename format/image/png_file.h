// Pictures as files.
#pragma once

#include "image/png.h"

#include <string>
#include <vector>

namespace drtv::image {

// Fails where a picture could not be written there, and, as wrong usage, for a name that does not end on .png
// (in any case of letters); asked before it is made. What is there and no PNG file is not replaced.
[[nodiscard]] cli::Result<void> check_png_target(const std::string& path);

// After the same check: whole or not at all, through links.
[[nodiscard]] cli::Result<void> write_png_file(const std::string& path,
                                               const Image& image,
                                               const std::vector<PngText>& texts = {});

}  // namespace drtv::image
