// Numbers of 16 bits (IEEE 754 binary16) from floats that are not below 0, and back. Without branches, so
// that a compiler makes many at once; with the same bits everywhere, as long as the CPU does not flush
// denormals.
#pragma once

#include <cstdint>
#include <cstring>

namespace drtv {

[[nodiscard]] inline std::uint32_t bits_of(float x) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
}
[[nodiscard]] inline float float_of(std::uint32_t bits) {
    float x = 0;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}

inline constexpr float half_largest = 65504;
inline constexpr std::uint32_t half_least_normal = 113u << 23;  // 2^-14, as a float's bits
inline constexpr std::uint32_t half_exponent_shift = (127u - 15u) << 23;
inline constexpr float half_subnormal_unit = 0.5f;  // its last bit stands where a subnormal half's does

// Nearest, ties to even; what is below 0 or no number gives 0, what is too large the largest number.
[[nodiscard]] inline std::uint16_t half_of(float x) {
    const float positive = x > 0 ? x : 0;
    const float bounded = positive < half_largest ? positive : half_largest;
    const std::uint32_t bits = bits_of(bounded);
    const std::uint32_t odd = (bits >> 13) & 1u;
    const std::uint32_t normal = (bits - half_exponent_shift + 0xFFFu + odd) >> 13;
    const std::uint32_t subnormal = bits_of(bounded + half_subnormal_unit) - bits_of(half_subnormal_unit);
    return static_cast<std::uint16_t>(bits < half_least_normal ? subnormal : normal);
}

// REQUIRES: not below 0, finite.
[[nodiscard]] inline float float_of_half(std::uint16_t half) {
    constexpr float two_to_112 = 5.192296858534828e+33f;
    return float_of(std::uint32_t{half} << 13) * two_to_112;
}

}  // namespace drtv
