#include "bakerd/reuse/footprint_recorder.h"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>

namespace drtv::reuse {
namespace {

constexpr float units_of_one = 0x1p18f;
static_assert(basis_count * 16 == 64);

__m128i as_lanes(std::uint64_t units) {
    return _mm_cvtsi64_si128(static_cast<long long>(units));
}

std::uint64_t as_units(__m128i lanes) {
    return static_cast<std::uint64_t>(_mm_cvtsi128_si64(lanes));
}

}  // namespace

FootprintRecorder::FootprintRecorder(map::SectorCoordinate sector, const FootprintGrid& grid)
    : sector_(sector), grid_(grid), walk_(grid), seen_(walk_.block_count()), shares_(walk_.block_count()) {
    for (std::vector<Units>& largest : largest_)
        largest.resize(shares_.size());
}

// Rounded up, and never 0: a path without any weight still shows in the file's counts.
FootprintRecorder::Units FootprintRecorder::units_of(const bake::Shares& shares) {
    const __m128 whole = _mm_ceil_ps(_mm_mul_ps(_mm_loadu_ps(shares.data()), _mm_set1_ps(units_of_one)));
    const __m128 clamped = _mm_max_ps(_mm_min_ps(whole, _mm_set1_ps(65535)), _mm_set1_ps(1));
    const __m128i lanes = _mm_cvtps_epi32(clamped);
    return as_units(_mm_packus_epi32(lanes, lanes));
}

void FootprintRecorder::count(std::size_t block, Units units) {
    shares_[block] = as_units(_mm_adds_epu16(as_lanes(shares_[block]), as_lanes(units)));
}

void FootprintRecorder::begin_probe(const glm::ivec3& position_units) {
    end_probe();
    quarter_ = quarter_of(sector_, position_units);
    number_.reset();
}

// The probe's shares join those of its quarter.
void FootprintRecorder::end_probe() {
    std::vector<Units>& largest = largest_[quarter_];
    for (std::size_t n = 0; n < shares_.size(); ++n) {
        largest[n] = as_units(_mm_max_epu16(as_lanes(largest[n]), as_lanes(shares_[n])));
        shares_[n] = 0;
    }
}

void FootprintRecorder::record_segments(std::span<const bake::PathSegment> segments) {
    for (const bake::PathSegment& segment : segments) {
        if (segment.implied)
            continue;
        if (number_ != segment.path) {
            number_ = segment.path;
            ++path_;
        }
        const Units units = units_of(segment.shares);
        for (const std::int32_t index : walk_.cross(segment.ray, segment.length_m)) {
            const auto block = static_cast<std::size_t>(index);
            count(block, seen_[block] == path_ ? 0 : units);
            seen_[block] = path_;
        }
    }
}

void FootprintRecorder::record_shadow_rays(std::span<const bake::ShadowRay> rays) {
    for (const bake::ShadowRay& shadow : rays) {
        const Units units = units_of(shadow.shares);
        for (const std::int32_t index : walk_.cross(shadow.ray, shadow.ray.far_m))
            count(static_cast<std::size_t>(index), units);
    }
}

void FootprintRecorder::merge_into(Footprint& footprint) {
    walk_.merge_into(footprint.crossed);
    end_probe();
    for (std::size_t quarter = 0; quarter < quarter_count; ++quarter) {
        for (std::size_t n = 0; n < grid_.block_count(); ++n) {
            const auto lanes = std::bit_cast<std::array<std::uint16_t, basis_count>>(largest_[quarter][n]);
            const float largest = static_cast<float>(*std::ranges::max_element(lanes)) / units_of_one;
            std::uint8_t& weight = footprint.weights[n * quarter_count + quarter];
            weight = std::max(weight, weight_code(largest));
        }
    }
}

void FootprintRecorders::store(Footprint& footprint) {
    footprint.grid = grid_;
    footprint.crossed.assign(grid_.column_count(), 0);
    footprint.weights.assign(grid_.block_count() * quarter_count, 0);
    merge_into(footprint);
}

void FootprintRecorders::merge_into(Footprint& footprint) {
    for (FootprintRecorder& recorder : recorders_)
        recorder.merge_into(footprint);
}

}  // namespace drtv::reuse
