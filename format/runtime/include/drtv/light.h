// Sun and sky of one moment as spherical harmonics, the form in which probes take them (M. Gilabert and
// N. Stefanov, "Deferred Radiance Transfer Volumes: Global Illumination in Far Cry 3", GDC 2012, slide 25;
// below "the talk").
//
// Radiance in W/(sr m2) and irradiance in W/m2, linear RGB with Rec. 709 primaries; any other unit will do,
// as long as the map's own lights (static irradiance, which is baked) are in the same unit. Directions are in
// the world: z up, any length, towards the light. Nothing here allocates or has state; every call is
// thread-safe.
//
//     const drtv::SkyColours colours{.zenith = {2, 4, 9}, .horizon = {5, 6, 8}, .sun_side = {3, 2, 1}};
//     drtv::SceneLight light;
//     light.sky = drtv::gradient_sky(colours, to_sun);
//     light.sun = {.irradiance = {300, 280, 240}, .direction = to_sun};
#pragma once

#include <drtv/conventions.h>

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace drtv {

// Two ways to use the same bytes.
enum class RelightMode : std::uint8_t {
    literal,   // the talk's code to the letter (slides 28, 29, 40 to 44)
    accurate,  // fitted sun, sky by K, weights that are linear in the normal: exact for light of two bands
};

// Radiance of a distant light as SH, a vector per channel: [r, g, b][Y0..Y3]. The sum of the coefficients
// times Y is the radiance on the upper hemisphere; what it is below the horizon does not matter.
using DistantLight = std::array<Float4, channel_count>;

// A sky of the same radiance everywhere.
[[nodiscard]] DistantLight constant_sky(const Float3& radiance);

// A sky of three colours: L(w) = horizon + (zenith - horizon) w.z + sun_side (1 + w.s) / 2, where s is the
// horizontal unit vector towards the sun. Two bands hold it exactly.
struct SkyColours {
    Float3 zenith{};
    Float3 horizon{};
    Float3 sun_side{};  // added on the side of the sun
};
// Where `to_sun` has no horizontal part or is not finite, s is 0.
[[nodiscard]] DistantLight gradient_sky(const SkyColours& colours, const Float3& to_sun);

// Any other sky: the least squares fit of two bands over the upper hemisphere.
struct SkySample {
    Float3 direction{};  // unit; those at or below the horizon do not count
    Float3 radiance{};
    float weight = 1;  // solid angle, in any unit
};
// Samples that are not finite do not count. Where samples in fewer than four directions leave the fit open,
// the one with the smallest coefficients is taken; no samples give a black sky. Cost: some 50 operations per
// sample.
[[nodiscard]] DistantLight fit_sky(std::span<const SkySample> samples);

// The sky's radiance in the unit direction `w`, w.z > 0.
using SkyRadiance = Float3 (*)(const Float3& w, void* user);
// Calls `radiance` for 4,096 directions.
[[nodiscard]] DistantLight fit_sky(SkyRadiance radiance, void* user);

struct Sun {
    Float3 irradiance{};           // on a surface that faces it
    Float3 direction{0, 0, 1.0f};  // towards the sun; at or below the horizon, or not finite: no sun
};
// The sun in the form of the mode: `literal` takes E Y(w); `accurate` fits the upper hemisphere, so that the
// sun's bounce from flat ground is right at every height of the sun.
[[nodiscard]] DistantLight sun_as_sh(RelightMode mode, const Sun& sun);

// The game's colour for the lights of one group (`light_group` in the map): 1 leaves them as they are in the
// map. If several name one group, the last counts.
struct GroupColour {
    std::string_view name;
    Float3 colour{1, 1, 1};
};

// All light of one moment except the game's own lamps.
struct SceneLight {
    RelightMode mode = RelightMode::accurate;
    DistantLight sky{};
    Sun sun{};
    Float3 static_colour{1, 1, 1};          // factor on the map's own lights that are in no group
    std::span<const GroupColour> groups{};  // must outlive this
    Float3 other_groups{};                  // factor on groups that are not named above
};

}  // namespace drtv
