// Relighting a probe on the CPU (s27-s32) and shading with its colours (s40-s44), as the talk's code does it.
// All colours are E/pi, linear Rec. 709. No allocation.
#pragma once

#include <drtv/sector.h>

#include <array>

namespace drtv {

// Radiance of the distant light as SH, a vector a channel: [r, g, b][Y0..Y3].
using DistantLight = std::array<Float4, channel_count>;

// What a relit probe is: one colour for each direction of the transfer basis.
using BasisColours = std::array<Float3, basis_count>;

// Sky of one radiance over the upper hemisphere, written as the constant SH the exact answers use.
[[nodiscard]] DistantLight constant_sky(const Float3& radiance);

// SH of a sun of `irradiance` (on a surface facing it) towards the unit direction `to_sun`.
[[nodiscard]] DistantLight directional_sun(const Float3& irradiance, const Float3& to_sun);

// Bounce of sky and sun plus the direct sky weighted by visibility (s28-s29).
[[nodiscard]] BasisColours relight(const Probe& probe, const DistantLight& sky, const DistantLight& sun);
// The same from a probe's codes where they lie (drtv/view.h).
[[nodiscard]] BasisColours relight(const TransferCodes& transfer,
                                   const VisibilityCodes& sky_visibility,
                                   const DistantLight& sky,
                                   const DistantLight& sun);

// Adds the light of the map's own lights, which no time of day changes. `tint` scales the channels of a light
// group: 1 is its lights as they are in the map, 0 is off.
void add_static_irradiance(BasisColours& colours,
                           const StaticIrradiance& light,
                           const Float3& tint = {1, 1, 1});

// What a light at a local source adds to the ambient light at a unit normal, by bounce: its direct light is
// the game's. `pair` and `scale` are what find_local_pair gives, `intensity` is the light's in W/sr.
// Two bands cannot follow a cosine lobe: where all light comes from one side, they say less than 0 on the
// other, down to as much as band 0 alone gives. It stays so, because it is linear: over several lights, and
// with the ambient light, what is missing here makes up for what is too much there. Clamp the sum at the end.
[[nodiscard]] Float3 shade_local(const LightCodes& pair,
                                 float scale,
                                 const Float3& intensity,
                                 const Float3& normal);

// Ambient at a unit normal by the basis weights of the shader (s43-s44).
[[nodiscard]] Float3 shade_ambient(const BasisColours& colours, const Float3& normal);

}  // namespace drtv
