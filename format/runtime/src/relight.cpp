#include <drtv/relight.h>

#include "simd.h"
#include "sky_direct.h"
#include "vector.h"

#include <algorithm>

namespace drtv {
namespace {

DistantLight sky_and_sun(const SceneLight& light) {
    DistantLight sum = sun_as_sh(light.mode, light.sun);
    for (std::size_t c = 0; c < channel_count; ++c) {
        for (std::size_t i = 0; i < sh_count; ++i)
            sum[c][i] += light.sky[c][i];
    }
    return sum;
}

template <class Numbers>
void scale(Numbers& numbers, float factor) {
    for (Float4& row : numbers) {
        for (float& number : row)
            number *= factor;
    }
}

// The four colours of one channel.
Lanes bounce_and_sky(const std::int16_t* transfer,
                     const Float4& bounce,
                     Lanes visibility,
                     const Float4& direct) {
    Lanes columns[sh_count];
    load_columns(transfer, columns);
    const Lanes even = columns[0] * splat(bounce[0]) + columns[2] * splat(bounce[2]);
    const Lanes odd = columns[1] * splat(bounce[1]) + columns[3] * splat(bounce[3]);
    return (even + odd) + visibility * load(direct.data());
}

float largest_of(Lanes lanes) {
    Float4 numbers;
    store(lanes, numbers.data());
    return std::max(std::max(numbers[0], numbers[1]), std::max(numbers[2], numbers[3]));
}

}  // namespace

ProbeRelighter::ProbeRelighter(const SectorView& sector, const SceneLight& light)
    : sector_(&sector), bounce_(sky_and_sun(light)), sky_direct_(sky_direct(light)) {
    scale(bounce_, transfer_scale / fixed_point_max);
    scale(sky_direct_, sky_visibility_scale / fixed_point_max);
    const auto per_code = [](const Float3& factor) {
        return Float4{
            factor[0] / fixed_point_max, factor[1] / fixed_point_max, factor[2] / fixed_point_max, 0};
    };
    if (!sector.static_irradiance.empty() && light.static_colour != Float3{})
        irradiance_[irradiance_count_++] = {
            sector.static_irradiance.data(), sector.static_exponents.data(), per_code(light.static_colour)};
    for (std::size_t g = 0; g < sector.light_group_names.size(); ++g) {
        const std::string_view name = light_group_name(sector, g);
        Float3 colour = light.other_groups;
        for (const GroupColour& group : light.groups) {
            if (group.name == name)
                colour = group.colour;
        }
        if (colour == Float3{})
            continue;
        const std::size_t first = g * sector.probe_count;
        irradiance_[irradiance_count_++] = {sector.light_group_irradiance.data() + first,
                                            sector.light_group_exponents.data() + first,
                                            per_code(colour)};
    }
}

// The arithmetic for one probe, four directions at once; and the same for two coefficients more at once,
// which gives the same bits: each product and each sum is rounded by itself, in the same order.
struct ProbeRelighter::Kernels {
    static void channels_of(const ProbeRelighter& r, std::size_t p, Lanes (&channels)[channel_count]) {
        const TransferCodes& transfer = r.sector_->transfer[p];
        const Lanes visibility = load_codes(r.sector_->sky_visibility[p].data());
        for (std::size_t c = 0; c < channel_count; ++c)
            channels[c] = bounce_and_sky(transfer[c][0].data(), r.bounce_[c], visibility, r.sky_direct_[c]);
        for (std::size_t n = 0; n < r.irradiance_count_; ++n) {
            const auto& [codes, exponents, factor] = r.irradiance_[n];
            const float scale = scale_of_exponent(exponents[p]);
            for (std::size_t c = 0; c < channel_count; ++c)
                channels[c] = channels[c] + load_codes(codes[p][c].data()) * splat(scale * factor[c]);
        }
    }

    static float pack_all(const ProbeRelighter& r, PackedColours* out) {
        Lanes largest = splat(0);
        for (std::size_t p = 0; p < r.sector_->probe_count; ++p) {
            Lanes channels[channel_count];
            channels_of(r, p, channels);
            Lanes rows[channel_count];
            pack_rows(channels, rows);
            for (std::size_t k = 0; k < channel_count; ++k) {
                largest = larger(rows[k], largest);
                store_halves(rows[k], out[p][k].data());
            }
        }
        return largest_of(largest);
    }

#if defined(DRTV_AVX2)
    // Two directions side by side, b0 | b1 and b2 | b3, each as r, g, b: so they leave for the textures.
    DRTV_AVX2 static __m256 both(__m128 v) {
        return _mm256_insertf128_ps(_mm256_castps128_ps256(v), v, 1);
    }
    DRTV_AVX2 static __m256 floats_of(const std::int16_t* codes) {
        return _mm256_cvtepi32_ps(
            _mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(codes))));
    }
    // Of x and y, (0 + 2, 1 + 3) each.
    DRTV_AVX2 static __m256 halves_of(__m256 x, __m256 y) {
        return _mm256_add_ps(_mm256_shuffle_ps(x, y, _MM_SHUFFLE(1, 0, 1, 0)),
                             _mm256_shuffle_ps(x, y, _MM_SHUFFLE(3, 2, 3, 2)));
    }
    DRTV_AVX2 static void add_irradiance(const Irradiance& light, std::size_t p, __m256& low, __m256& high) {
        const std::int16_t* codes = light.codes[p][0].data();
        const __m128i red_green = _mm_loadu_si128(reinterpret_cast<const __m128i*>(codes));
        const __m128i blue = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(codes + 8));
        const __m128i pairs = _mm_unpacklo_epi16(red_green, _mm_srli_si128(red_green, 8));
        const __m128i blues = _mm_unpacklo_epi16(blue, _mm_setzero_si128());
        const __m256 first = _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(_mm_unpacklo_epi32(pairs, blues)));
        const __m256 second = _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(_mm_unpackhi_epi32(pairs, blues)));
        const __m128 scale = _mm_set1_ps(scale_of_exponent(light.exponents[p]));
        const __m256 factor = both(_mm_mul_ps(scale, _mm_loadu_ps(light.factor.data())));
        low = _mm256_add_ps(low, _mm256_mul_ps(first, factor));
        high = _mm256_add_ps(high, _mm256_mul_ps(second, factor));
    }

    DRTV_AVX2 static float pack_all_avx2(const ProbeRelighter& r, PackedColours* out) {
        const SectorView& sector = *r.sector_;
        __m256 bounce[channel_count];
        for (std::size_t c = 0; c < channel_count; ++c)
            bounce[c] = both(_mm_loadu_ps(r.bounce_[c].data()));
        const auto direct = [&](std::size_t b) DRTV_AVX2 {
            return _mm_set_ps(0, r.sky_direct_[2][b], r.sky_direct_[1][b], r.sky_direct_[0][b]);
        };
        const __m256 direct_low = _mm256_insertf128_ps(_mm256_castps128_ps256(direct(0)), direct(1), 1);
        const __m256 direct_high = _mm256_insertf128_ps(_mm256_castps128_ps256(direct(2)), direct(3), 1);
        const __m256i first_two = _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1);
        const __m256i last_two = _mm256_setr_epi32(2, 2, 2, 2, 3, 3, 3, 3);
        const __m256i downward = _mm256_setr_epi32(4, 4, 4, 4, 5, 5, 5, 5);  // r and g of b3
        const __m256 none = _mm256_setzero_ps();
        const __m256 most = _mm256_set1_ps(half_largest);
        __m256 largest = none;
        for (std::size_t p = 0; p < sector.probe_count; ++p) {
            const std::int16_t* codes = sector.transfer[p][0][0].data();
            __m256 low[channel_count];
            __m256 high[channel_count];
            for (std::size_t c = 0; c < channel_count; ++c) {
                low[c] = _mm256_mul_ps(floats_of(codes + 16 * c), bounce[c]);
                high[c] = _mm256_mul_ps(floats_of(codes + 16 * c + 8), bounce[c]);
            }
            const __m256 red_green_low = halves_of(low[0], low[1]);
            const __m256 red_green_high = halves_of(high[0], high[1]);
            const __m256 blue = halves_of(low[2], high[2]);
            __m256 lower = _mm256_add_ps(_mm256_shuffle_ps(red_green_low, blue, _MM_SHUFFLE(2, 0, 2, 0)),
                                         _mm256_shuffle_ps(red_green_low, blue, _MM_SHUFFLE(3, 1, 3, 1)));
            __m256 upper = _mm256_add_ps(_mm256_shuffle_ps(red_green_high, blue, _MM_SHUFFLE(2, 2, 2, 0)),
                                         _mm256_shuffle_ps(red_green_high, blue, _MM_SHUFFLE(3, 3, 3, 1)));
            const __m128i seen =
                _mm_loadl_epi64(reinterpret_cast<const __m128i*>(sector.sky_visibility[p].data()));
            const __m256 visibility = _mm256_castps128_ps256(_mm_cvtepi32_ps(_mm_cvtepi16_epi32(seen)));
            lower = _mm256_add_ps(lower,
                                  _mm256_mul_ps(_mm256_permutevar8x32_ps(visibility, first_two), direct_low));
            upper = _mm256_add_ps(upper,
                                  _mm256_mul_ps(_mm256_permutevar8x32_ps(visibility, last_two), direct_high));
            for (std::size_t n = 0; n < r.irradiance_count_; ++n)
                add_irradiance(r.irradiance_[n], p, lower, upper);

            const __m256 rows = _mm256_blend_ps(lower, _mm256_permutevar8x32_ps(upper, downward), 0x88);
            const __m256 down = _mm256_permute2f128_ps(upper, upper, 0x11);
            const __m256 row = _mm256_blend_ps(upper, _mm256_permute_ps(down, _MM_SHUFFLE(2, 2, 2, 2)), 0x08);
            const __m256 rows_seen = _mm256_max_ps(rows, none);
            const __m256 row_seen = _mm256_max_ps(row, none);
            largest = _mm256_max_ps(rows_seen, largest);
            largest = _mm256_max_ps(_mm256_blend_ps(row_seen, none, 0xF0), largest);
            auto* to = reinterpret_cast<__m128i*>(out[p][0].data());
            _mm_storeu_si128(to, _mm256_cvtps_ph(_mm256_min_ps(rows_seen, most), _MM_FROUND_TO_NEAREST_INT));
            const __m128 last = _mm256_castps256_ps128(_mm256_min_ps(row_seen, most));
            _mm_storel_epi64(to + 1, _mm_cvtps_ph(last, _MM_FROUND_TO_NEAREST_INT));
        }
        return std::max(largest_of({_mm256_castps256_ps128(largest)}),
                        largest_of({_mm256_extractf128_ps(largest, 1)}));
    }
#endif
};

BasisColours ProbeRelighter::operator()(std::size_t p) const {
    Lanes channels[channel_count];
    Kernels::channels_of(*this, p, channels);
    std::array<Float4, channel_count> rows;
    for (std::size_t c = 0; c < channel_count; ++c)
        store(channels[c], rows[c].data());
    BasisColours colours;
    for (std::size_t b = 0; b < basis_count; ++b)
        colours[b] = {rows[0][b], rows[1][b], rows[2][b]};
    return colours;
}

float ProbeRelighter::pack_all(std::span<PackedColours> out) const {
#if defined(DRTV_AVX2)
    if (has_avx2())
        return Kernels::pack_all_avx2(*this, out.data());
#endif
    return Kernels::pack_all(*this, out.data());
}

BasisColours relight(const SectorView& sector, std::size_t p, const SceneLight& light) {
    return ProbeRelighter(sector, light)(p);
}

BasisColours relight(const TransferCodes& transfer,
                     const VisibilityCodes& sky_visibility,
                     const SceneLight& light) {
    SectorView sector;
    sector.probe_count = 1;
    sector.transfer = {&transfer, 1};
    sector.sky_visibility = {&sky_visibility, 1};
    return relight(sector, 0, light);
}

BasisColours clamped(const BasisColours& colours) {
    BasisColours result;
    for (std::size_t b = 0; b < basis_count; ++b) {
        for (std::size_t c = 0; c < channel_count; ++c)
            result[b][c] = colours[b][c] > 0 ? colours[b][c] : 0;
    }
    return result;
}

}  // namespace drtv
