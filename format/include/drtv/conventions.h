// Conventions shared by baker and game: axes, basis, spherical harmonics, fixed point. The normative text is
// SPEC.md, section 2; SPEC.md has every constant of this header too. "The talk" in this and other headers is
// M. Gilabert and N. Stefanov, "Deferred Radiance Transfer Volumes: Global Illumination in Far Cry 3", GDC
// 2012.
//
// Everything is constexpr, pure and thread-safe.
//
//     float seen = drtv::decode_fixed(codes[b], drtv::sky_visibility_scale);   // 0 to 1
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace drtv {

using Float3 = std::array<float, 3>;
using Float4 = std::array<float, 4>;
using Double3 = std::array<double, 3>;  // a place in the world, in metres

// World: right-handed, z up, metres. A sector is a square with sides of this length, at all heights (slide 24
// of the talk).
inline constexpr int sector_size_m = 64;

// Positions are whole multiples of 2^-10 m, so that 16 bits span one sector's side exactly.
inline constexpr int position_units_per_m = 1024;
inline constexpr float position_unit_m = 1.0f / position_units_per_m;

inline constexpr std::size_t basis_count = 4;
inline constexpr std::size_t sh_count = 4;
inline constexpr std::size_t channel_count = 3;

// The transfer basis (slide 40 of the talk): three directions around up, one straight down.
inline constexpr std::array<Float3, basis_count> transfer_basis = {{{-0.408248f, -0.707107f, 0.577350f},
                                                                    {-0.408248f, 0.707107f, 0.577350f},
                                                                    {0.816497f, 0.0f, 0.577350f},
                                                                    {0.0f, 0.0f, -1.0f}}};

// E/pi around basis direction b under an open sky of radiance 1, 0 to 1: the part of the cosine lobe that
// lies above the horizon.
[[nodiscard]] constexpr float open_sky_share(std::size_t b) {
    return (1 + transfer_basis[b][2]) / 2;
}

// Real spherical harmonics of bands 0 and 1, no Condon-Shortley sign.
inline constexpr float sh_y0 = 0.282095f;
inline constexpr float sh_y1 = 0.488603f;

// Y0..Y3 at the unit direction `w`, in the order 1, y, z, x.
[[nodiscard]] constexpr Float4 evaluate_sh(const Float3& w) {
    return {sh_y0, sh_y1 * w[1], sh_y1 * w[2], sh_y1 * w[0]};
}

inline constexpr std::size_t max_probes = 255;  // per sector; index 255 means "no probe"
inline constexpr std::uint8_t no_probe = 255;

inline constexpr std::size_t max_local_sources = 128;              // per probe: those that send light to it
inline constexpr std::size_t max_sector_sources = 9 * max_probes;  // per sector, with its neighbours' probes

inline constexpr std::size_t grid_size = 16;  // cells along each axis
inline constexpr std::size_t grid_cell_count = grid_size * grid_size * grid_size;

// Fixed point: value = scale * q / 32767, q in [-32767, 32767]; -32768 is never written.
inline constexpr float fixed_point_max = 32767.0f;
inline constexpr float transfer_scale = 0.5f;
inline constexpr float sky_visibility_scale = 1.0f;

// Bounds of the transfer coefficients of any passive scene (SPEC.md, section 3): 1/(2 sqrt pi) for i = 0 and
// sqrt(3/(4 pi)) for i > 0.
inline constexpr float transfer_bound_y0 = 0.2821f;
inline constexpr float transfer_bound_y1 = 0.4887f;

// The scale that a file stores as an exponent: 2^exponent, exact. The exponent is clamped to -126 to 126, so
// that every scale is a normal float.
[[nodiscard]] constexpr float scale_of_exponent(int exponent) {
    constexpr int limit = 126, float_bias = 127, float_mantissa_bits = 23;
    const auto biased = static_cast<std::uint32_t>(std::clamp(exponent, -limit, limit) + float_bias);
    return __builtin_bit_cast(float, biased << float_mantissa_bits);  // some compilers lack std::bit_cast
}

[[nodiscard]] constexpr float decode_fixed(std::int16_t q, float scale) {
    return static_cast<float>(q) / fixed_point_max * scale;
}

// Nearest code to `value`, ties away from zero, saturated to +-32767. NaN gives 0. REQUIRES: `scale` is a
// power of two, so that the quotient and all else up to the rounding are exact in double.
[[nodiscard]] constexpr std::int16_t encode_fixed(float value, float scale) {
    constexpr double max = fixed_point_max;
    const double q = static_cast<double>(value) / static_cast<double>(scale) * max;
    if (!(q == q))
        return 0;
    if (q >= max)
        return 32767;
    if (q <= -max)
        return -32767;
    return static_cast<std::int16_t>(q + (q < 0 ? -0.5 : 0.5));
}

}  // namespace drtv
