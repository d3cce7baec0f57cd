// What becomes of an earlier result, and why.
#pragma once

#include <cstdint>

namespace drtv::reuse {

enum class Verdict : std::uint8_t {
    hit,       // the same bytes
    near_hit,  // no coefficient differs by more than the bound
    rebake,
};

// Why a result does not hold, or what came nearest to that.
enum class Cause : std::uint8_t {
    rays,       // rays cross where the thing is or was
    placement,  // it may move probes
    light,      // it shines on the sector's probes
    interior,   // it is the sector's own
};

}  // namespace drtv::reuse
