// Relighting probes on the CPU: from what a sector file holds and the light of the moment to four colours per
// probe (slides 26 to 32 of the talk, see drtv/light.h), and from these to the ambient light at a normal
// (slides 40 to 44).
//
// Colours are E/pi: what a white Lambert surface would radiate, in the unit of the light. All calls are pure
// and thread-safe, none allocates, and results have the same bits on every CPU. Cost: some 10 ns per probe.
//
//     const drtv::BasisColours colours = drtv::relight(sector, probe, light);
//     const drtv::Float3 ambient = drtv::shade_ambient(light.mode, colours, normal);
#pragma once

#include <drtv/light.h>
#include <drtv/sector.h>
#include <drtv/view.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace drtv {

// What a relit probe is: one colour for each direction of the transfer basis, [b][r, g, b].
using BasisColours = std::array<Float3, basis_count>;

// The same in numbers of binary16, packed as the talk's textures are (slide 40): [k] holds r, g, b of basis
// direction k and, last, channel k of the downward one. Nothing below 0; 65504 at most.
using PackedColours = std::array<std::array<std::uint16_t, 4>, channel_count>;

[[nodiscard]] PackedColours packed(const BasisColours& colours);
[[nodiscard]] BasisColours unpacked(const PackedColours& colours);

// A `SceneLight` made ready for many probes of one sector.
class ProbeRelighter {
  public:
    // The names of light groups are looked up here. `sector` must outlive this.
    ProbeRelighter(const SectorView& sector, const SceneLight& light);

    // Bounce of sky and sun, the sky's direct light by its visibility, and the map's own lights. Not clamped:
    // where two bands cannot follow the light, a colour may be below 0. REQUIRES: p < sector.probe_count.
    [[nodiscard]] BasisColours operator()(std::size_t p) const;

    // All probes at once, packed. Gives the largest number, before packing. REQUIRES: out has room for
    // sector.probe_count.
    float pack_all(std::span<PackedColours> out) const;

  private:
    // Codes of irradiance, one per probe. 1/32767 is in the factor, a probe's exponent is not.
    struct Irradiance {
        const LightCodes* codes;
        const std::int8_t* exponents;
        Float4 factor;  // by channel
    };
    struct Kernels;

    const SectorView* sector_;
    DistantLight bounce_{};                           // [c][i], of transfer codes
    std::array<Float4, channel_count> sky_direct_{};  // [c][b], of visibility codes
    std::array<Irradiance, 1 + max_light_groups> irradiance_{};
    std::size_t irradiance_count_ = 0;
};

// One probe. REQUIRES: p < sector.probe_count.
[[nodiscard]] BasisColours relight(const SectorView& sector, std::size_t p, const SceneLight& light);
// Sun and sky alone, from a probe's codes.
[[nodiscard]] BasisColours relight(const TransferCodes& transfer,
                                   const VisibilityCodes& sky_visibility,
                                   const SceneLight& light);

// Whether time has gone on far enough (slide 35 of the talk): some colour of the sector's probes, or of an
// open sky, would change by more than `step` from what is shown, as packed. Half a code of an RGBA8 volume is
// scale / 510; of one by square roots it is scale / 255 at the scale, and less the darker a colour is. Lamps
// do not count. The two lights need lists of groups of their own. Cost: as relighting the sector twice.
[[nodiscard]] bool relight_needed(const SectorView& sector,
                                  const SceneLight& shown,
                                  const SceneLight& now,
                                  float step);

// Where a colour leaves relighting for shading or a texture, nothing is below 0. What is not a number is 0.
[[nodiscard]] BasisColours clamped(const BasisColours& colours);

// What each basis direction sees of an open sky: visibility (1, 1, 1, 0), nothing bounced. Not clamped.
[[nodiscard]] BasisColours open_sky(const SceneLight& light);

// Adds the light of the map's own lights to colours. `factor` scales the channels.
void add_static_irradiance(BasisColours& colours,
                           const StaticIrradiance& light,
                           const Float3& factor = {1, 1, 1});

// What a light at a local source adds to the ambient light at a unit normal, by bounce: its direct light is
// the game's. `pair` and `scale` are what find_local_pair gives, `intensity` is the light's in W/sr.
// Two bands cannot follow a cosine lobe: where all light comes from one side, they say less than 0 on the
// other, down to as much as band 0 alone gives. It stays so, because it is linear: over several lights, and
// with the ambient light, what is missing here makes up for what is too much there. Clamp the sum at the end.
[[nodiscard]] Float3 shade_local(const LightCodes& pair,
                                 float scale,
                                 const Float3& intensity,
                                 const Float3& normal);

// Weights of the four colours at a unit normal. A normal without a length gives defined weights too.
[[nodiscard]] Float4 basis_weights(RelightMode mode, const Float3& normal);

// The ambient light at a unit normal; nothing below 0. REQUIRES: colours are clamped.
[[nodiscard]] Float3 shade_ambient(RelightMode mode, const BasisColours& colours, const Float3& normal);

}  // namespace drtv
