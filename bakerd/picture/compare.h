// A picture beside a path-traced one of the same view and light, and how far off the ambient light is, by
// part and by cause.
#pragma once

#include "bakerd/picture/moment.h"
#include "bakerd/picture/shot.h"
#include "format/image/png.h"

#include <cstdint>
#include <string>

namespace drtv::picture {

struct CompareSettings {
    std::uint32_t paths = 64;  // a pixel
};

// What is relit, what is true, and what would be relit if the probes' colours were true, from left to right.
struct Comparison {
    image::Image picture;
    std::string table;  // lines of text
};

[[nodiscard]] Comparison compare_with_paths(const Shot& shot,
                                            const Moment& moment,
                                            const CompareSettings& settings,
                                            float exposure);

}  // namespace drtv::picture
