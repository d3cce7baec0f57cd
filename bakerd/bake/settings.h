// What can be asked of a bake. Checked once on entry; all but the tolerance part of every result's key.
#pragma once

#include "bakerd/map/digest.h"

#include <cstdint>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace drtv::bake {

// Raised whenever the same map and settings begin to give other bytes.
inline constexpr std::uint32_t baker_version = 6;

struct Settings {
    std::uint32_t rays = 2048;  // primary rays a probe, 16 to 65536
    std::uint32_t bounces = 3;  // surface bounces, 0 to 8
    float reach_m = 512;        // farther than this from the probe is sky, 1 to 8192
    float min_distance_m = 6;   // between automatic probes, 1 to 16
    float error =
        0;  // standard error to stop at, with `rays` as the budget (bake/integrate.h); 0 to 1, 0: all rays
    bool local_transfer = false;
    std::uint32_t local_bounces = 2;  // surface bounces of local transfer, 1 to 4
    std::uint32_t local_rays = 1024;  // traced from each of its sources, 16 to 4096
    // The change of any coefficient, as a share of its range, up to which an older result may stand in
    // (assessment.h); 0 to 0.0625, 0: none. Not of the bake itself.
    float tolerance = 1 / 512.0f;

    bool operator==(const Settings&) const = default;
};

// "draft", "console" or "pc"; a sentence for any other name.
[[nodiscard]] tl::expected<Settings, std::string> preset(std::string_view name);

// Sets `rays`, `bounces`, `reach`, `min_distance`, `error`, `lprt`, `lprt_bounces`, `lprt_rays` or
// `tolerance` from text; a sentence for an unknown key or a value out of range, and then `settings` is as
// before.
[[nodiscard]] tl::expected<void, std::string> set(Settings& settings,
                                                  std::string_view key,
                                                  std::string_view value);

// Digest over settings that a file's bytes follow from, format version, baker version and ISA class: all but
// the map and the sector.
[[nodiscard]] map::Digest settings_key(const Settings& settings);

}  // namespace drtv::bake
