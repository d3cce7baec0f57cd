// Whether a result that was baked of one map still holds for another: its footprint against what changed
// between the two.
#pragma once

#include "bakerd/bake/world.h"
#include "bakerd/reuse/footprint.h"
#include "bakerd/reuse/inventory.h"
#include "bakerd/reuse/verdict.h"
#include "settings/bake_settings.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace drtv::reuse {

struct Assessment {
    Verdict verdict = Verdict::hit;
    // On the change of any coefficient, as a share of its range; of a hit 0, and 1 and more means that no
    // bound is known.
    float bound = 0;
    float tolerance = 0;  // with which it was assessed
    // What a bake can take over (rebake.h): whether probes stand where they stood, with how many rays of
    // each solid test may end otherwise; and how much of each probe may differ. No bounds where only the
    // whole can be baked again.
    bool placement_holds = true;
    bool placed_again = false;  // to find that out: what was recorded of the solid tests is out of date
    std::vector<std::uint8_t> flips;
    std::vector<float> probe_bounds;
    float gain = 1;         // of a path's weight, in all bounds (Footprint::gain)
    float static_gain = 0;  // of static light alone (Footprint::static_gain)
    // The change with the largest bound; nothing of a hit.
    std::optional<std::size_t> change;  // index
    Cause cause = Cause::rays;
    float change_bound = 0;  // of that change alone
};

// Whether the result of a bake with `settings` holds for the map of `world`; `changes` are those from the
// baked map to it. The settings' tolerance is the largest bound of a near hit; 0 asks for the same bytes. The
// bound covers all changes together. Only the difference of the two maps counts: an edit that was undone does
// not.
//
// Ranges of coefficients: sky visibility 1, radiance transfer 0.2821 (i = 0) and 0.9772 (i > 0), static
// irradiance bake::static_irradiance_range. REQUIRES: a FloatMode on this thread.
[[nodiscard]] Assessment assess(const Footprint& footprint,
                                const settings::JobSettings& settings,
                                std::span<const Change> changes,
                                bake::World& world);

// Of the sector's probes those that a bake cannot take over. REQUIRES: the verdict is rebake.
[[nodiscard]] float share_to_bake(const Assessment& assessment);

}  // namespace drtv::reuse
