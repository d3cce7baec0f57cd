// Shares of lamps, as many at once as a LocalRelighter takes.
#pragma once

#include <drtv/local_lights.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace drtv {

// Whether a sector is another one or beside it: only so far do the files know sources.
[[nodiscard]] inline bool is_beside(const SectorView& sector, SectorId other) {
    return std::abs(std::int64_t{other.i} - sector.i) <= 1 && std::abs(std::int64_t{other.j} - sector.j) <= 1;
}

// Calls `use(relighter)` until all shares were in one.
template <class Use>
void for_each_batch(const LoadedSector& sector, std::span<const LightShare> shares, const Use& use) {
    for (std::size_t first = 0; first < shares.size(); first += LocalRelighter::max_shares) {
        const std::size_t count = std::min(shares.size() - first, LocalRelighter::max_shares);
        use(LocalRelighter(sector, shares.subspan(first, count)));
    }
}

}  // namespace drtv
