// The ambient light at a place and a normal, worked out on the CPU from the files themselves: for what a game
// lights there (particles, characters), and what every shader is checked against.
//
// Pure, thread-safe, no allocation. Cost: 2 to 6 us between eight probes, less by the nearest, more
// in interiors.
//
//     const drtv::Ambient ambient = drtv::ambient_at(set, light, {}, {.at = {x, y, z}, .normal = n});
//     use(ambient.colour);
#pragma once

#include <drtv/local_lights.h>
#include <drtv/relight.h>
#include <drtv/sector_set.h>
#include <drtv/volume.h>

#include <cstdint>
#include <span>

namespace drtv {

// How far off themselves surfaces should ask: less finds what is behind thin walls, more passes the far side
// of an alley.
inline constexpr float surface_offset_m = 1;

enum class Sampling : std::uint8_t { nearest, trilinear };

struct AmbientPlace {
    Double3 at{};            // metres
    Float3 normal{0, 0, 1};  // unit
    Sampling sampling = Sampling::trilinear;
    // Probes and interiors are asked so far along the normal. 0 is for what floats freely, a particle or a
    // character; a surface takes surface_offset_m, or it finds what is behind it.
    float offset_m = 0;
    bool interiors = true;  // and what is in none is lit by outdoors' probes (SectorSet::outdoors)
    float interior_soft_m = 1;
};

// What the colour is made of; they add up to it where nothing is below 0.
struct AmbientParts {
    Float3 sky_direct{};
    Float3 sky_bounce{};
    Float3 sun_bounce{};
    Float3 static_light{};  // with light groups
    Float3 local{};         // lamps that move
    Float3 fallback{};      // an open sky times sky_factor, where no probe is known
};

struct Ambient {
    // In an interior alone, `inside`; where its probe has a share and the rest is the fallback, `fading`.
    PlaceStatus status = PlaceStatus::sector_missing;
    ProbeShare probe;  // that the grid names for the place; sector is null where it names none
    InteriorShare interior;
    BasisColours colours{};  // E/pi; each probe's, lamps included, are clamped at 0 before they are blended
    AmbientParts parts;      // at the normal
    Float3 colour{};         // E/pi at the normal, nothing below 0
};

// What is not finite gives the fallback. `lamps`: what split_light made of all of them.
[[nodiscard]] Ambient ambient_at(const SectorSet& set,
                                 const SceneLight& light,
                                 std::span<const LightShare> lamps,
                                 const AmbientPlace& place);

// The same as a shader finds it in a volume that was filled with this light: `place.sampling` does not count.
// With interiors the volume's `outdoors` should be set, as a shader's that blends them.
// Outside the window, and fading over its last texel, there is an open sky times sky_factor (slide 57);
// status and parts say so. Parts are not encoded, so that they add up to the colour but for what the texels
// round.
[[nodiscard]] Ambient ambient_in(const Volume& volume,
                                 const SectorSet& set,
                                 const SceneLight& light,
                                 std::span<const LightShare> lamps,
                                 const AmbientPlace& place);

}  // namespace drtv
