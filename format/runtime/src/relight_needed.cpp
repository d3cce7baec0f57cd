#include <drtv/relight.h>

#include <cmath>

namespace drtv {

bool relight_needed(const SectorView& sector, const SceneLight& shown, const SceneLight& now, float step) {
    const auto differ = [step](const BasisColours& unclamped, const BasisColours& others) {
        const BasisColours a = clamped(unclamped);
        const BasisColours b = clamped(others);
        bool any = false;
        for (std::size_t n = 0; n < basis_count; ++n) {
            for (std::size_t c = 0; c < channel_count; ++c)
                any = any || !(std::abs(a[n][c] - b[n][c]) <= step);
        }
        return any;
    };
    const ProbeRelighter before(sector, shown);
    const ProbeRelighter after(sector, now);
    bool needed = shown.mode != now.mode || differ(open_sky(shown), open_sky(now));
    for (std::size_t p = 0; p < sector.probe_count && !needed; ++p)
        needed = differ(before(p), after(p));
    return needed;
}

}  // namespace drtv
