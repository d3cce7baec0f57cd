// The ambient light at a place and a normal, computed on the CPU from the files themselves: for what a game
// lights on the CPU (particles, characters), and as the reference for every shader.
//
// Pure, thread-safe, no allocation. Cost: 2 to 6 us with trilinear sampling, less with the nearest probe,
// more in interiors.
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

// The offset along its normal at which a surface should ask, in metres. A smaller one finds probes behind
// thin walls; a larger one goes past the far side of an alley.
inline constexpr float surface_offset_m = 1;

enum class Sampling : std::uint8_t { nearest, trilinear };

struct AmbientPlace {
    Double3 at{};            // metres
    Float3 normal{0, 0, 1};  // unit
    Sampling sampling = Sampling::trilinear;
    // Probes and interiors are asked at this distance along the normal, in metres. 0 is for what floats
    // freely, a particle or a character. A surface takes surface_offset_m, or it finds what is behind it.
    float offset_m = 0;
    bool interiors = true;  // used; outside of them outdoor probes light (SectorSet::outdoors)
    float interior_soft_m = 1;
};

// The parts of the colour, in E/pi. They add up to it where nothing is below 0.
struct AmbientParts {
    Float3 sky_direct{};
    Float3 sky_bounce{};
    Float3 sun_bounce{};
    Float3 static_light{};  // with light groups
    Float3 local{};         // lamps that move
    Float3 fallback{};      // an open sky times sky_factor, where no probe is known
};

struct Ambient {
    // `inside` where only an interior's probe lights; `fading` where it has a share and the rest is the
    // fallback.
    PlaceStatus status = PlaceStatus::sector_missing;
    ProbeShare probe;  // the one that the grid names; sector is null where it names none
    InteriorShare interior;
    BasisColours colours{};  // E/pi; each probe's, with lamps, are clamped at 0 before they are blended
    AmbientParts parts;      // at the normal
    Float3 colour{};         // E/pi at the normal, nothing below 0
};

// A place that is not finite gets the fallback. `lamps`: the shares that split_light made of all lamps.
[[nodiscard]] Ambient ambient_at(const SectorSet& set,
                                 const SceneLight& light,
                                 std::span<const LightShare> lamps,
                                 const AmbientPlace& place);

// The same as a shader finds it in a volume that was filled with this light; `place.sampling` is ignored.
// With interiors the volume's `outdoors` should be set, as for a shader that blends them. Outside the window,
// and fading in over its last texel, the light is an open sky times sky_factor (slide 57); status and parts
// say so. Parts are not encoded, so they add up to the colour except for the rounding of the texels.
[[nodiscard]] Ambient ambient_in(const Volume& volume,
                                 const SectorSet& set,
                                 const SceneLight& light,
                                 std::span<const LightShare> lamps,
                                 const AmbientPlace& place);

}  // namespace drtv
