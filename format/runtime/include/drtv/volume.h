// The volumes that a GPU samples: the colours of the probes around a camera, in three textures that follow it
// (slides 33 to 36 and 60 of the talk, see drtv/light.h). Texture k holds r, g, b of basis direction k and,
// in alpha, channel k of the downward one (slide 40).
//
// Along an axis with texels of width w, texel m of the world covers [m w, (m + 1) w) and is lit by the probe
// that the grid names at its centre. It is stored at m mod N in a texture of N texels, so that only the
// planes that come in are written while the camera moves. A shader samples at
// `frac((place - SnappedCamera) UVScale + 1/2 + VolumeWrapOffset)`; `shader_inputs` gives these values. After
// any moves the textures are byte for byte what a full update writes.
//
// Memory: one block of the caller's, which holds the texels too. Threads: `update` writes texels and runs
// alone on its volume; it reads the set and the probes, so these must not change meanwhile. `texels` and
// `dirty` are for the upload after `update`. Several volumes of one set may be updated at once.
//
//     drtv::Volume volume(memory, {}, limits);
//     volume.update(set, relit, camera);            // each frame
//     for (const drtv::TextureBox& box : volume.dirty()) upload(box);
#pragma once

#include <drtv/relit_probes.h>
#include <drtv/sector_set.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace drtv {

enum class TexelEncoding : std::uint8_t {
    rgba8,       // the talk's: floor(255 x / scale + 1/2). For banding in the dark see docs/runtime.md
    rgba8_sqrt,  // the square root of x / scale, likewise; square it after filtering
    rgba16f,     // binary16; the scale is ignored
};

struct VolumeSettings {
    std::array<std::int32_t, 3> size = {96, 96, 16};  // texels along x, y, z; each 2 to 1024
    std::array<float, 3> texel_m = {4, 4, 4};         // width of a texel; 0.25 to 64 m
    TexelEncoding encoding = TexelEncoding::rgba8;
    // One more texel on each side, a copy of the texel on the opposite side, for samplers that clamp:
    // textures then are N + 2 wide, and the shader samples at (frac(...) N + 1) / (N + 2). Without borders
    // the sampler must repeat.
    bool borders = true;
    // One texture with the three stacked along z, for one sampler. REQUIRES: borders.
    bool atlas = false;
    // Leaves out the probes of interiors (SectorSet::outdoor_probes), for a shader that blends them itself.
    bool outdoors = false;
    // (1 2 1) / 4 along each axis, on linear colours; at the window's sides the last texel counts twice.
    bool blur = false;
};

// A box of texels, the same in all three textures. With borders, texel 0 is the first border texel.
struct TextureBox {
    std::array<std::int32_t, 3> offset{};
    std::array<std::int32_t, 3> size{};
};

// The inputs of a shader, as in the talk's code (slide 40). Places are relative to a camera that was snapped
// to texels, so that floats are exact far from the origin too.
struct VolumeShaderInputs {
    Double3 snapped_camera{};  // the window's middle: subtract it on the CPU, in double
    Float3 uv_scale{};         // 1 / (N texel_m)
    Float3 wrap_offset{};      // 0 to 1
    Float3 uvw_multiply{};     // after frac: uvw * uvw_multiply + uvw_add; 1 and 0 without borders
    Float3 uvw_add{};
    float scale = 1;  // of RGBA8: value of code 255
};

// A scale for RGBA8: a power of two, 2 to 4 times the largest colour. `current` is kept while the largest
// colour is at most 1/2 and above 1/8 of it, so that the scale does not change while that colour changes by
// less than a factor of two. Above 0. Where `largest` is not above 0: `current` if that is above 0, else 1.
[[nodiscard]] float suggest_scale(float largest, float current);

class Volume {
  public:
    // `limits` are those of the sets that will be shown.
    [[nodiscard]] static std::size_t memory_bytes(const VolumeSettings& settings,
                                                  const SectorSetLimits& limits);
    // False where a setting lies outside its range: such a volume must not be made.
    [[nodiscard]] static bool is_possible(const VolumeSettings& settings);

    // REQUIRES: as for SectorSet; is_possible(settings).
    Volume(std::span<std::byte> memory, const VolumeSettings& settings, const SectorSetLimits& limits);
    Volume(const Volume&) = delete;
    Volume& operator=(const Volume&) = delete;

    // Sets the scale of RGBA8. After a change the next update writes all texels. REQUIRES: scale > 0.
    void set_scale(float scale);
    [[nodiscard]] float scale() const;

    // Moves the window to the camera and writes what is not there or has changed: planes that came in,
    // sectors that were loaded, dropped or relit, tiles. A camera that is not finite or outside the world
    // leaves the window where it is. Places for which no relit probe is known get the fallback.
    void update(const SectorSet& set, const RelitProbes& relit, const Double3& camera_m);
    // The same, but writes every texel.
    void update_all(const SectorSet& set, const RelitProbes& relit, const Double3& camera_m);

    // What the last update wrote; a texel may lie in several boxes.
    [[nodiscard]] std::span<const TextureBox> dirty() const;

    // The size of one texture, borders included, or of the whole atlas, in texels along x, y, z.
    [[nodiscard]] std::array<std::int32_t, 3> texture_size() const;
    [[nodiscard]] std::size_t texel_bytes() const;
    // Texture k, x fastest, then y, then z. In an atlas, its k-th third. REQUIRES: k < 3.
    [[nodiscard]] std::span<const std::byte> texels(std::size_t k) const;

    [[nodiscard]] VolumeShaderInputs shader_inputs() const;
    // The window's lowest texel, in texels of the world. Nothing has been written before the first update.
    [[nodiscard]] std::array<std::int32_t, 3> window() const;
    [[nodiscard]] bool is_filled() const;
    [[nodiscard]] const VolumeSettings& settings() const;

    // What a shader finds at a place by linear filtering between texels, and how much of that counts. It
    // leaves out interiors and the distance; ambient_in (drtv/ambient.h) has both. On the CPU, for tests and
    // tools.
    struct Sample {
        BasisColours colours{};  // decoded
        // 1 inside the window, falling to 0 half a texel before its sides: from there on the distance lights
        // (slide 57).
        float weight = 0;
    };
    [[nodiscard]] Sample sample(const Double3& world_m) const;

    struct State;

  private:
    State* state_;  // in the caller's memory
};

}  // namespace drtv
