// Which probes light a place, and how much: what the runtime blends there, taken apart.
#pragma once

#include "bakerd/picture/moment.h"

#include <array>
#include <cstddef>

namespace drtv::picture {

// Shares add up to 1 with the fallback's.
struct ProbeMix {
    // Of an interior 1, of each of eight texels 1, or of up to 8 probes around.
    std::array<ProbeShare, 9> probes{};
    std::size_t count = 0;
    float fallback = 0;

    void add(const ProbeShare& probe, float share) {
        probes[count] = probe;
        probes[count++].share = share;
    }
};

[[nodiscard]] ProbeMix mix_at(const Moment& moment, const glm::vec3& at, const glm::vec3& normal);

}  // namespace drtv::picture
