#include <drtv/relight.h>

#include "half.h"

#include <cmath>

namespace drtv {

bool relight_needed(const SectorView& sector, const SceneLight& shown, const SceneLight& now, float step) {
    if (shown.mode != now.mode)
        return true;
    std::array<PackedColours, max_probes + 1> before;
    std::array<PackedColours, max_probes + 1> after;
    ProbeRelighter(sector, shown).pack_all(before);
    ProbeRelighter(sector, now).pack_all(after);
    before[sector.probe_count] = packed(open_sky(shown));
    after[sector.probe_count] = packed(open_sky(now));
    for (std::size_t p = 0; p <= sector.probe_count; ++p) {
        for (std::size_t k = 0; k < channel_count; ++k) {
            for (std::size_t c = 0; c < before[p][k].size(); ++c) {
                const float change = float_of_half(after[p][k][c]) - float_of_half(before[p][k][c]);
                if (!(std::abs(change) <= step))
                    return true;
            }
        }
    }
    return false;
}

}  // namespace drtv
