// Four floats at once, with the same bits from SSE2, NEON and plain C++: each operation is rounded by itself,
// in the order in which it is written. DRTV_SCALAR chooses the plain one, DRTV_NO_AVX2 leaves out what asks
// the CPU for more than SSE2.
#pragma once

#include "half.h"

#include <cstdint>

#if defined(__FAST_MATH__)
#error "drtv must not be compiled with -ffast-math: its results are the same everywhere"
#endif

#if !defined(DRTV_SCALAR) && defined(__SSE2__)
#define DRTV_SSE2
#include <emmintrin.h>
#if defined(__GNUC__) && defined(__x86_64__) && !defined(DRTV_NO_AVX2)
#define DRTV_AVX2 __attribute__((target("avx2,f16c")))
#include <immintrin.h>
#endif
#elif !defined(DRTV_SCALAR) && defined(__aarch64__)
#define DRTV_NEON
#include <arm_neon.h>
#endif

namespace drtv {

#if defined(DRTV_AVX2)
// Every CPU with AVX2 converts to binary16 too.
inline bool has_avx2() {
    return __builtin_cpu_supports("avx2") != 0;
}
#endif

#if defined(DRTV_SSE2)

struct Lanes {
    __m128 v;
};
inline Lanes splat(float x) {
    return {_mm_set1_ps(x)};
}
inline Lanes load(const float* x) {
    return {_mm_loadu_ps(x)};
}
inline void store(Lanes a, float* x) {
    _mm_storeu_ps(x, a.v);
}
inline Lanes operator+(Lanes a, Lanes b) {
    return {_mm_add_ps(a.v, b.v)};
}
inline Lanes operator*(Lanes a, Lanes b) {
    return {_mm_mul_ps(a.v, b.v)};
}
// What is not a number becomes 0.
inline Lanes at_least_zero(Lanes a) {
    return {_mm_max_ps(a.v, _mm_setzero_ps())};
}
inline Lanes low_half_of(__m128i codes) {
    return {_mm_cvtepi32_ps(_mm_srai_epi32(_mm_unpacklo_epi16(codes, codes), 16))};
}
inline Lanes high_half_of(__m128i codes) {
    return {_mm_cvtepi32_ps(_mm_srai_epi32(_mm_unpackhi_epi16(codes, codes), 16))};
}
inline Lanes load_codes(const std::int16_t* codes) {
    return low_half_of(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(codes)));
}
// 16 codes [b][i]; out[i] holds those of the four b.
inline void load_columns(const std::int16_t* codes, Lanes (&out)[4]) {
    const __m128i rows01 = _mm_loadu_si128(reinterpret_cast<const __m128i*>(codes));
    const __m128i rows23 = _mm_loadu_si128(reinterpret_cast<const __m128i*>(codes + 8));
    const __m128i even = _mm_unpacklo_epi16(rows01, rows23);
    const __m128i odd = _mm_unpackhi_epi16(rows01, rows23);
    const __m128i columns01 = _mm_unpacklo_epi16(even, odd);
    const __m128i columns23 = _mm_unpackhi_epi16(even, odd);
    out[0] = low_half_of(columns01);
    out[1] = high_half_of(columns01);
    out[2] = low_half_of(columns23);
    out[3] = high_half_of(columns23);
}

// Rows to columns; of the last row, column k goes to the end of row k: r, g, b of each direction and, last,
// channel k of the fourth.
inline void pack_rows(const Lanes (&channels)[3], Lanes (&rows)[3]) {
    const __m128 high = _mm_unpackhi_ps(channels[0].v, channels[1].v);
    __m128 last = _mm_shuffle_ps(high, channels[2].v, _MM_SHUFFLE(3, 3, 3, 2));
    __m128 r = channels[0].v;
    __m128 g = channels[1].v;
    __m128 b = channels[2].v;
    _MM_TRANSPOSE4_PS(r, g, b, last);
    rows[0] = {r};
    rows[1] = {g};
    rows[2] = {b};
}
inline Lanes larger(Lanes a, Lanes b) {
    return {_mm_max_ps(a.v, b.v)};
}
// half_of four numbers.
inline void store_halves(Lanes a, std::uint16_t* to) {
    const __m128 positive = _mm_max_ps(a.v, _mm_setzero_ps());
    const __m128 bounded = _mm_min_ps(positive, _mm_set1_ps(half_largest));
    const __m128i bits = _mm_castps_si128(bounded);
    const __m128i odd = _mm_and_si128(_mm_srli_epi32(bits, 13), _mm_set1_epi32(1));
    const __m128i biased =
        _mm_add_epi32(bits, _mm_set1_epi32(static_cast<int>(0xFFFu - half_exponent_shift)));
    const __m128i normal = _mm_srli_epi32(_mm_add_epi32(biased, odd), 13);
    const __m128 unit = _mm_set1_ps(half_subnormal_unit);
    const __m128i subnormal =
        _mm_sub_epi32(_mm_castps_si128(_mm_add_ps(bounded, unit)), _mm_castps_si128(unit));
    const __m128i is_subnormal = _mm_cmplt_epi32(bits, _mm_set1_epi32(static_cast<int>(half_least_normal)));
    const __m128i halves =
        _mm_or_si128(_mm_and_si128(is_subnormal, subnormal), _mm_andnot_si128(is_subnormal, normal));
    // At most 0x7BFF, so that signed saturation does no harm.
    _mm_storel_epi64(reinterpret_cast<__m128i*>(to), _mm_packs_epi32(halves, halves));
}

#elif defined(DRTV_NEON)

struct Lanes {
    float32x4_t v;
};
inline Lanes splat(float x) {
    return {vdupq_n_f32(x)};
}
inline Lanes load(const float* x) {
    return {vld1q_f32(x)};
}
inline void store(Lanes a, float* x) {
    vst1q_f32(x, a.v);
}
inline Lanes operator+(Lanes a, Lanes b) {
    return {vaddq_f32(a.v, b.v)};
}
inline Lanes operator*(Lanes a, Lanes b) {
    return {vmulq_f32(a.v, b.v)};
}
inline Lanes at_least_zero(Lanes a) {
    return {vmaxnmq_f32(a.v, vdupq_n_f32(0))};
}
inline Lanes load_codes(const std::int16_t* codes) {
    return {vcvtq_f32_s32(vmovl_s16(vld1_s16(codes)))};
}
inline void load_columns(const std::int16_t* codes, Lanes (&out)[4]) {
    const int16x4x4_t columns = vld4_s16(codes);
    for (int i = 0; i < 4; ++i)
        out[i] = {vcvtq_f32_s32(vmovl_s16(columns.val[i]))};
}
inline void pack_rows(const Lanes (&channels)[3], Lanes (&rows)[3]) {
    float in[3][4];
    for (int c = 0; c < 3; ++c)
        store(channels[c], in[c]);
    for (int k = 0; k < 3; ++k) {
        const float row[4] = {in[0][k], in[1][k], in[2][k], in[k][3]};
        rows[k] = load(row);
    }
}
inline Lanes larger(Lanes a, Lanes b) {
    return {vmaxnmq_f32(a.v, b.v)};
}
inline void store_halves(Lanes a, std::uint16_t* to) {
    const float32x4_t positive = vmaxnmq_f32(a.v, vdupq_n_f32(0));
    const float32x4_t bounded = vminq_f32(positive, vdupq_n_f32(half_largest));
    vst1_u16(to, vreinterpret_u16_f16(vcvt_f16_f32(bounded)));
}

#else

struct Lanes {
    float v[4];
};
inline Lanes splat(float x) {
    return {{x, x, x, x}};
}
inline Lanes load(const float* x) {
    return {{x[0], x[1], x[2], x[3]}};
}
inline void store(Lanes a, float* x) {
    for (int n = 0; n < 4; ++n)
        x[n] = a.v[n];
}
inline Lanes operator+(Lanes a, Lanes b) {
    for (int n = 0; n < 4; ++n)
        a.v[n] += b.v[n];
    return a;
}
inline Lanes operator*(Lanes a, Lanes b) {
    for (int n = 0; n < 4; ++n)
        a.v[n] *= b.v[n];
    return a;
}
inline Lanes at_least_zero(Lanes a) {
    for (float& x : a.v)
        x = x > 0 ? x : 0;
    return a;
}
inline Lanes load_codes(const std::int16_t* codes) {
    Lanes a;
    for (int n = 0; n < 4; ++n)
        a.v[n] = static_cast<float>(codes[n]);
    return a;
}
inline void load_columns(const std::int16_t* codes, Lanes (&out)[4]) {
    for (int i = 0; i < 4; ++i) {
        for (int b = 0; b < 4; ++b)
            out[i].v[b] = static_cast<float>(codes[4 * b + i]);
    }
}
inline void pack_rows(const Lanes (&channels)[3], Lanes (&rows)[3]) {
    for (int k = 0; k < 3; ++k)
        rows[k] = {{channels[0].v[k], channels[1].v[k], channels[2].v[k], channels[k].v[3]}};
}
inline Lanes larger(Lanes a, Lanes b) {
    for (int n = 0; n < 4; ++n)
        a.v[n] = a.v[n] > b.v[n] ? a.v[n] : b.v[n];
    return a;
}
inline void store_halves(Lanes a, std::uint16_t* to) {
    for (int n = 0; n < 4; ++n)
        to[n] = half_of(a.v[n]);
}

#endif

}  // namespace drtv
