// The encoding of PNG's colours (IEC 61966-2-1).
#pragma once

#include <cstdint>

namespace drtv::kit {

// The nearest code of a linear value; what is below 0 or not a number is 0, above 1 is 255. The same on every
// machine.
[[nodiscard]] std::uint8_t encode_srgb(float linear);

}  // namespace drtv::kit
