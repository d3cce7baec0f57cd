// What of a map a baked sector depends on (docs/design.md, promise 2): where its rays went, with how much
// weight, and where its placement looked. As long as nothing changes there, the sector's file stays the same,
// byte for byte (assessment.h).
#pragma once

#include "bakerd/bake/placed_sector.h"
#include "bakerd/map/digest.h"
#include "bakerd/map/ground.h"
#include "bakerd/reuse/footprint_grid.h"
#include "placement/placement.h"
#include "settings/bake_settings.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace drtv::reuse {

// Of what a record says, and how: results whose record is of another version are never candidates.
inline constexpr std::uint32_t footprint_version = 6;

// Results of a sector with the same key may stand for each other, where their records say so: settings_key
// and the version of the records.
[[nodiscard]] map::Digest results_key(const settings::BakeSettings& settings);

// What is known of a probe beyond what its file says.
struct ProbeRecord {
    placement::Position position{};
    // Its share of the file's statistics.
    std::uint32_t rays = 0;
    std::uint32_t shadow_rays = 0;
    float error = 0;
    // The weight of its paths that may have changed since it was baked: above 0 where the probe was copied
    // from a result of another map, within a tolerance. Times the gain it bounds how far its coefficients are
    // off.
    float changed_weight = 0;

    bool operator==(const ProbeRecord&) const = default;
};

struct Footprint {
    map::SectorCoordinate sector;
    float reach_m = 0;
    std::uint32_t rays = 0;  // from each probe
    // Nothing is known of how much a change would matter: local transfer, or a number of rays that follows
    // from what they find.
    bool without_bounds = false;
    // The most that a path can bring from static lights, over bake::static_irradiance_range (static_gain.h);
    // 0 where there are none. The maximum over all maps from which any of these probes was baked.
    float static_gain = 0;
    float max_scattered = 1;  // of their surfaces (trace::max_scattered), above 0
    float placement_m = 0;    // how far around the sector a change may move its probes
    map::Digest placement;    // placement_digest

    std::vector<ProbeRecord> probes;
    // Where rays went; the probes' first ones need no record: they follow from where the probes stand.
    FootprintGrid grid;
    std::vector<std::uint64_t> crossed;             // by column: its layers that a ray crossed
    std::vector<std::uint8_t> weights;              // by block and quarter, as codes (README.md)
    std::vector<placement::SolidTest> solid_tests;  // sorted
    std::vector<std::string> placement_warnings;

    bool operator==(const Footprint&) const = default;

    // What a path's weight counts: the sky's radiance is 1.
    [[nodiscard]] float gain() const { return static_gain < 1 ? 1 : static_gain; }
    // On how far any coefficient is off.
    [[nodiscard]] float bound() const {
        float weight = 0;
        for (const ProbeRecord& probe : probes)
            weight = weight < probe.changed_weight ? probe.changed_weight : weight;
        return weight * gain();
    }
    [[nodiscard]] std::uint8_t weight(std::size_t block, std::size_t quarter) const {
        return weights[block * quarter_count + quarter];
    }
};

}  // namespace drtv::reuse
