// What is at one pixel of a picture.
#pragma once

#include "bakerd/picture/moment.h"
#include "bakerd/picture/shot.h"

#include <string>

namespace drtv::picture {

// As a JSON object, with the time where it is not empty. `pixel`: x,y from the upper left corner, from 0.
// Fails where the picture has no such pixel.
[[nodiscard]] cli::Result<std::string> picked(const Shot& shot,
                                              const Moment& moment,
                                              const std::string& time,
                                              const std::string& pixel);

}  // namespace drtv::picture
