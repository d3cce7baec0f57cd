// Whether a result that was baked of one map still holds for another: its footprint against what changed
// between the two.
#pragma once

#include "bakerd/bake/footprint.h"
#include "bakerd/bake/inventory.h"
#include "bakerd/bake/sampling.h"
#include "bakerd/bake/world.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drtv::bake {

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

struct Assessment {
    Verdict verdict = Verdict::hit;
    float bound = 0;  // on the change of any coefficient, as a share of its range; of a hit 0, and 1 and more
                      // means that no bound is known
    // What a bake can take over (sector_bake.h): whether probes stand where they stood, with how many rays of
    // each solid test may end otherwise; and how much of each probe may differ. No bounds where only the
    // whole can be baked again.
    bool placement_holds = true;
    std::vector<std::uint8_t> flips;
    std::vector<float> probe_bounds;
    float gain = 1;         // of a path's weight, in all bounds (Footprint::gain)
    float static_gain = 0;  // of static light alone (Footprint::static_gain)
    // Of the change that weighs most; nothing of a hit.
    std::optional<std::size_t> change;  // index
    Cause cause = Cause::rays;
    float weight = 0;  // of that change alone
};

// Whether the result of a bake with `settings` holds for the map of `world`; `changes` are those from the
// baked map to it. `tolerance` is the largest bound of a near hit; 0 asks for the same bytes. The bound
// covers all changes together, and edits in between are none of its concern: one that is undone counts
// nothing.
//
// Ranges of coefficients: sky visibility 1, radiance transfer 0.2821 (i = 0) and 0.9772 (i > 0), static
// irradiance static_irradiance_range. REQUIRES: a FloatMode on this thread.
[[nodiscard]] Assessment assess(const Footprint& footprint,
                                const Settings& settings,
                                std::span<const Change> changes,
                                float tolerance,
                                World& world);

// Of the sector's probes those that a bake cannot take over. REQUIRES: the verdict is rebake.
[[nodiscard]] float share_to_bake(const Assessment& assessment, float tolerance);

// "palm_017 moved: rays cross column (12, 7), weight 0.8 %".
[[nodiscard]] std::string describe(const Assessment& assessment, std::span<const Change> changes);

}  // namespace drtv::bake
