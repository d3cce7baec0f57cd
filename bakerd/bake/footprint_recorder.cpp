#include "bakerd/bake/footprint_recorder.h"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace drtv::bake {
namespace {

constexpr float units_of_one = 0x1p18f;
static_assert(basis_count * 16 == 64);

__m128i as_lanes(std::uint64_t units) {
    return _mm_cvtsi64_si128(static_cast<long long>(units));
}
std::uint64_t as_units(__m128i lanes) {
    return static_cast<std::uint64_t>(_mm_cvtsi128_si64(lanes));
}

struct Span {
    float from, to;
};

// Where a ray is between two planes.
Span between(float low, float high, float origin, float direction) {
    // Never quite along them: no division gives a number that is none.
    const float inverse = 1 / (std::abs(direction) < 1e-12f ? 1e-12f : direction);
    const float a = (low - origin) * inverse, b = (high - origin) * inverse;
    return {std::min(a, b), std::max(a, b)};
}

// For each choice of 8 lanes their numbers, one byte each from the lowest.
constexpr std::array<std::uint64_t, 256> chosen_lanes = [] {
    std::array<std::uint64_t, 256> table{};
    for (unsigned choice = 0; choice < table.size(); ++choice) {
        unsigned shift = 0;
        for (unsigned lane = 0; lane < 8; ++lane) {
            if ((choice >> lane & 1u) == 0)
                continue;
            table[choice] |= std::uint64_t{lane} << shift;
            shift += 8;
        }
    }
    return table;
}();

// Appends the lanes that are chosen, and leaves what it likes beyond. REQUIRES: room for 8.
std::int32_t* append(std::int32_t* end, __m256i lanes, unsigned choice) {
    const __m256i order =
        _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(chosen_lanes[choice])));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(end), _mm256_permutevar8x32_epi32(lanes, order));
    return end + std::popcount(choice);
}

// Lanes, each with its bit, in which two differ.
unsigned differing(__m256i a, __m256i b) {
    return ~static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(a, b)))) & 0xFFu;
}

// Of eight numbers that go on from those before, each lane's predecessor.
__m256i predecessors(__m256i lanes, __m256i before) {
    const __m256i turn = _mm256_setr_epi32(7, 0, 1, 2, 3, 4, 5, 6);
    return _mm256_blend_epi32(
        _mm256_permutevar8x32_epi32(lanes, turn), _mm256_permutevar8x32_epi32(before, turn), 1);
}

}  // namespace

FootprintRecorder::FootprintRecorder(const FootprintGrid& grid)
    : grid_(grid),
      crossed_(static_cast<std::size_t>(grid.columns + 2) * static_cast<std::size_t>(grid.rows + 2)),
      // What crosses the border by rounding counts for blocks that nobody asks for.
      seen_(grid.block_count() + static_cast<std::size_t>((grid.columns + 4) * (grid.layers + 1) / 2)),
      shares_(seen_.size()) {
    for (std::vector<Units>& most : most_)
        most.resize(shares_.size());
}

// Rounded up, and never 0: a path without any weight still shows in the file's counts.
FootprintRecorder::Units FootprintRecorder::units_of(const Shares& shares) {
    const __m128 whole = _mm_ceil_ps(_mm_mul_ps(_mm_loadu_ps(shares.data()), _mm_set1_ps(units_of_one)));
    const __m128i lanes = _mm_cvtps_epi32(_mm_max_ps(_mm_min_ps(whole, _mm_set1_ps(65535)), _mm_set1_ps(1)));
    return as_units(_mm_packus_epi32(lanes, lanes));
}

void FootprintRecorder::count(std::size_t block, Units units) {
    shares_[block] = as_units(_mm_adds_epu16(as_lanes(shares_[block]), as_lanes(units)));
}

void FootprintRecorder::begin(std::size_t quarter) {
    fold();
    quarter_ = quarter;
    number_.reset();
}

// The probe's shares join those of its quarter.
void FootprintRecorder::fold() {
    std::vector<Units>& most = most_[quarter_];
    for (std::size_t n = 0; n < shares_.size(); ++n) {
        most[n] = as_units(_mm_max_epu16(as_lanes(most[n]), as_lanes(shares_[n])));
        shares_[n] = 0;
    }
}

// Takes points along the ray, a little less than a cell's width apart, eight at once: none waits for the one
// before. Between two of them the ray passes one side of a cell at most in x, and one in y; where it passes
// both, it may have been in either of the two cells at the corner, and is noted in both. Heights in a point's
// cell are those from the point before to the one after.
std::span<const std::int32_t> FootprintRecorder::cross(const trace::Ray& ray, float length_m) {
    const glm::vec3 low = grid_.low(), high = grid_.high();
    float from = 0, to = length_m;
    if (const float end = ray.origin.z + ray.direction.z * length_m;
        ray.origin.z < low.z || ray.origin.z >= high.z || end < low.z || end >= high.z) {
        const Span heights = between(low.z, high.z, ray.origin.z, ray.direction.z);
        from = std::max(heights.from, 0.0f);
        to = std::min(heights.to, length_m);
        if (!(from <= to))
            return {};
    }
    const float per_side = 1 / static_cast<float>(grid_.cell_m),
                per_height = 1 / static_cast<float>(grid_.layer_m);  // exact: powers of two
    const glm::vec3 scale(per_side, per_side, per_height), origin = (ray.origin - low) * scale,
                                                           direction = ray.direction * scale;
    const float step = static_cast<float>(grid_.cell_m) * (1 - 0x1p-7f),
                top = static_cast<float>(grid_.layers) - 0.5f;
    constexpr std::int32_t width = 8;
    // A whole number of steps: all distances are exact then, and a point is the same from both sides.
    from = std::floor(from / step) * step;
    const auto count = static_cast<std::int32_t>((to - from) / step) + 2;
    const auto points = static_cast<std::size_t>(count + width);
    // Of each point seven blocks and two corners at most.
    if (list_.size() < 7 * points)
        list_.resize(7 * points);
    if (corner_columns_.size() < corners_ + 2 * points) {
        cross_corners();
        for (std::vector<std::int32_t>* list : {&corner_columns_, &corner_layers_})
            list->resize(std::max(list->size(), 16 * points));
    }
    std::int32_t *corner_columns = corner_columns_.data() + corners_,
                 *corner_layers = corner_layers_.data() + corners_;

    const auto all = [](float value) { return _mm256_set1_ps(value); };
    const auto at = [&](glm::length_t axis, __m256 distance) {
        return _mm256_add_ps(all(origin[axis]), _mm256_mul_ps(all(direction[axis]), distance));
    };
    const auto cell_at = [&](glm::length_t axis, __m256 distance) {
        return _mm256_cvttps_epi32(at(axis, distance));
    };
    const auto layer_at = [&](__m256 distance) {
        return _mm256_cvttps_epi32(
            _mm256_min_ps(_mm256_max_ps(at(2, distance), _mm256_setzero_ps()), all(top)));
    };
    const auto half = [](__m256i lanes) { return _mm256_srai_epi32(lanes, 1); };
    // All numbers of cells are below 2^15.
    const __m256i pitch = _mm256_set1_epi32(grid_.columns + 2),
                  block_columns = _mm256_set1_epi32((grid_.columns + 1) >> 1),
                  block_layers = _mm256_set1_epi32((grid_.layers + 1) >> 1);
    const auto column_of = [&](__m256i i, __m256i j) {
        return _mm256_add_epi32(_mm256_madd_epi16(j, pitch), i);
    };
    const auto stack_of = [&](__m256i i, __m256i j) {
        return _mm256_madd_epi16(_mm256_add_epi32(_mm256_madd_epi16(half(j), block_columns), half(i)),
                                 block_layers);
    };
    const auto store = [](std::array<std::int32_t, width>& numbers, __m256i lanes) {
        _mm256_store_si256(reinterpret_cast<__m256i*>(numbers.data()), lanes);
    };
    alignas(32) std::array<std::int32_t, width> columns, lowest, highest;

    __m256 number = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
    __m256i last_stacks = _mm256_set1_epi32(-1);
    std::int32_t* end = list_.data();
    for (std::int32_t n = 0; n < count; n += width) {
        // Beyond the end the last point again: it adds nothing.
        const __m256 distance = _mm256_add_ps(all(from), _mm256_mul_ps(number, all(step)));
        const __m256 before = _mm256_max_ps(_mm256_sub_ps(distance, all(step)), all(from)),
                     here = _mm256_min_ps(distance, all(to)),
                     after = _mm256_min_ps(_mm256_add_ps(distance, all(step)), all(to));
        number = _mm256_add_ps(number, all(width));
        const __m256i i = cell_at(0, here), j = cell_at(1, here), next_i = cell_at(0, after),
                      next_j = cell_at(1, after);
        const __m256i first = layer_at(_mm256_min_ps(before, here)), middle = layer_at(here),
                      last = layer_at(after);
        const __m256i stacks = stack_of(i, j);
        store(columns, column_of(i, j));
        store(lowest, _mm256_min_epi32(first, last));
        store(highest, _mm256_max_epi32(first, last));
        for (std::size_t k = 0; k < width; ++k)
            crossed_[static_cast<std::size_t>(columns[k])] |= layers_between(lowest[k], highest[k]);

        // In a stack that it comes from it was up to here.
        const __m256i first_block = half(first), middle_block = half(middle), last_block = half(last);
        const unsigned enters = differing(stacks, predecessors(stacks, last_stacks));
        const unsigned climbs = differing(middle_block, last_block);
        end = append(end, _mm256_add_epi32(stacks, last_block), enters | climbs);
        end = append(end, _mm256_add_epi32(stacks, middle_block), enters & climbs);
        end =
            append(end, _mm256_add_epi32(stacks, first_block), enters & differing(first_block, middle_block));
        last_stacks = stacks;

        const unsigned corners = differing(i, next_i) & differing(j, next_j);
        const __m256i layers = _mm256_or_si256(_mm256_min_epi32(middle, last),
                                               _mm256_slli_epi32(_mm256_max_epi32(middle, last), 8));
        corner_columns =
            append(append(corner_columns, column_of(i, next_j), corners), column_of(next_i, j), corners);
        corner_layers = append(append(corner_layers, layers, corners), layers, corners);
        const unsigned stacks_too =
            corners & differing(half(i), half(next_i)) & differing(half(j), half(next_j));
        if (stacks_too == 0)
            continue;
        for (const __m256i corner : {stack_of(i, next_j), stack_of(next_i, j)}) {
            end = append(end, _mm256_add_epi32(corner, middle_block), stacks_too);
            end = append(end, _mm256_add_epi32(corner, last_block), stacks_too & climbs);
        }
    }
    corners_ = static_cast<std::size_t>(corner_columns - corner_columns_.data());
    return {list_.data(), end};
}

void FootprintRecorder::cross_corners() {
    for (std::size_t n = 0; n < corners_; ++n)
        crossed_[static_cast<std::size_t>(corner_columns_[n])] |=
            layers_between(corner_layers_[n] & 0xFF, corner_layers_[n] >> 8);
    corners_ = 0;
}

void FootprintRecorder::path(const trace::Ray& ray,
                             float length_m,
                             const Shares& shares,
                             std::uint32_t number) {
    const Units units = units_of(shares);
    if (number_ != number) {
        number_ = number;
        ++path_;
    }
    for (const std::int32_t index : cross(ray, length_m)) {
        const auto block = static_cast<std::size_t>(index);
        count(block, seen_[block] == path_ ? 0 : units);
        seen_[block] = path_;
    }
}

void FootprintRecorder::lone(const trace::Ray& ray, const Shares& shares) {
    const Units units = units_of(shares);
    for (const std::int32_t index : cross(ray, ray.far_m))
        count(static_cast<std::size_t>(index), units);
}

void FootprintRecorder::merge_into(Footprint& footprint) {
    cross_corners();
    for (std::int32_t j = 0; j < grid_.rows; ++j) {
        for (std::int32_t i = 0; i < grid_.columns; ++i)
            footprint.crossed[grid_.column(i, j)] |=
                crossed_[static_cast<std::size_t>(j) * static_cast<std::size_t>(grid_.columns + 2) +
                         static_cast<std::size_t>(i)];
    }
    fold();
    for (std::size_t quarter = 0; quarter < quarter_count; ++quarter) {
        for (std::size_t n = 0; n < grid_.block_count(); ++n) {
            const auto lanes = std::bit_cast<std::array<std::uint16_t, basis_count>>(most_[quarter][n]);
            std::uint8_t& weight = footprint.weights[n * quarter_count + quarter];
            weight = std::max(
                weight, weight_code(static_cast<float>(*std::ranges::max_element(lanes)) / units_of_one));
        }
    }
}

}  // namespace drtv::bake
