// Relights probes on the CPU: turns what a sector file holds and the light of the moment into four colours
// per probe (slides 26 to 32 of the talk, see drtv/light.h), and these into the ambient light at a normal
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

// A relit probe: one colour for each direction of the transfer basis, [b][r, g, b].
using BasisColours = std::array<Float3, basis_count>;

// The same in binary16, packed like the talk's textures (slide 40): [k] holds r, g, b of basis direction k
// and then channel k of the downward one. 0 to 65504.
using PackedColours = std::array<std::array<std::uint16_t, 4>, channel_count>;

[[nodiscard]] PackedColours packed(const BasisColours& colours);
[[nodiscard]] BasisColours unpacked(const PackedColours& colours);

// A `SceneLight` prepared for many probes of one sector.
class ProbeRelighter {
  public:
    // The names of light groups are looked up here. `sector` must outlive this.
    ProbeRelighter(const SectorView& sector, const SceneLight& light);

    // Bounce of sky and sun, the sky's direct light by its visibility, and the map's own lights. Not clamped:
    // where two bands cannot follow the light, a colour may be below 0. REQUIRES: p < sector.probe_count.
    [[nodiscard]] BasisColours operator()(std::size_t p) const;

    // Relights all probes and packs them. Returns the largest number before packing. REQUIRES: out has room
    // for sector.probe_count.
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

// Whether the light has changed enough to relight (slide 35 of the talk): some packed colour of the sector's
// probes, or of an open sky, would change by more than `step`. For half a code of an `rgba8` volume it is
// scale / 510; of an `rgba8_sqrt` volume, scale / 255 for a colour at the scale and less for darker ones.
// Lamps do not count. The two lights must not share one list of groups. Cost: that of relighting the sector
// twice.
[[nodiscard]] bool relight_needed(const SectorView& sector,
                                  const SceneLight& shown,
                                  const SceneLight& now,
                                  float step);

// Colours as shading and textures take them: negative values and NaN become 0.
[[nodiscard]] BasisColours clamped(const BasisColours& colours);

// What each basis direction sees of an open sky: visibility (1, 1, 1, 0), nothing bounced. Not clamped.
[[nodiscard]] BasisColours open_sky(const SceneLight& light);

// Adds the light of the map's own lights to colours. `factor` scales the channels.
void add_static_irradiance(BasisColours& colours,
                           const StaticIrradiance& light,
                           const Float3& factor = {1, 1, 1});

// What a light at a local source adds to the ambient light at a unit normal by bounce; its direct light is
// left to the game. `pair` and `scale` are what find_local_pair gives, `intensity` is the light's in W/sr.
// Two bands cannot follow a cosine lobe: where all light comes from one side, the result on the other side is
// below 0, down to minus what band 0 alone gives. It is not clamped, so that it stays linear: over several
// lights, and with the ambient light, what is missing on one side makes up for what is too much on the other.
// Clamp the sum at the end.
[[nodiscard]] Float3 shade_local(const LightCodes& pair,
                                 float scale,
                                 const Float3& intensity,
                                 const Float3& normal);

// Weights of the four colours at a unit normal. A normal of length 0 gives defined weights too.
[[nodiscard]] Float4 basis_weights(RelightMode mode, const Float3& normal);

// The ambient light at a unit normal; nothing below 0. REQUIRES: colours are clamped.
[[nodiscard]] Float3 shade_ambient(RelightMode mode, const BasisColours& colours, const Float3& normal);

}  // namespace drtv
