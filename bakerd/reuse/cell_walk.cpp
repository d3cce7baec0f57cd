#include "bakerd/reuse/cell_walk.h"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace drtv::reuse {
namespace {

constexpr std::int32_t width = 8;
using Lanes = std::array<std::int32_t, width>;

// For each choice of 8 lanes their numbers, one byte each from the lowest.
constexpr std::array<std::uint64_t, 256> chosen_lanes = [] {
    std::array<std::uint64_t, 256> table{};
    for (unsigned choice = 0; choice < table.size(); ++choice) {
        unsigned shift = 0;
        for (unsigned lane = 0; lane < width; ++lane) {
            if ((choice >> lane & 1u) == 0)
                continue;
            table[choice] |= std::uint64_t{lane} << shift;
            shift += 8;
        }
    }
    return table;
}();

// Appends the lanes that are chosen. The contents after the returned end are unspecified. REQUIRES: room
// for 8.
std::int32_t* append(std::int32_t* end, __m256i lanes, unsigned choice) {
    const __m128i numbers = _mm_cvtsi64_si128(static_cast<long long>(chosen_lanes[choice]));
    const __m256i order = _mm256_cvtepu8_epi32(numbers);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(end), _mm256_permutevar8x32_epi32(lanes, order));
    return end + std::popcount(choice);
}

void store(Lanes& numbers, __m256i lanes) {
    _mm256_store_si256(reinterpret_cast<__m256i*>(numbers.data()), lanes);
}

// Lanes, each with its bit, in which two differ.
unsigned differing(__m256i a, __m256i b) {
    return ~static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(a, b)))) & 0xFFu;
}

// Of eight numbers that go on from those before, each lane's predecessor.
__m256i predecessors(__m256i lanes, __m256i before) {
    const __m256i turn = _mm256_setr_epi32(7, 0, 1, 2, 3, 4, 5, 6);
    const __m256i turned = _mm256_permutevar8x32_epi32(lanes, turn);
    return _mm256_blend_epi32(turned, _mm256_permutevar8x32_epi32(before, turn), 1);
}

__m256i half(__m256i lanes) {
    return _mm256_srai_epi32(lanes, 1);
}

// Cells along a ray.
class Cells {
  public:
    Cells(const FootprintGrid& grid, const trace::Ray& ray) {
        const float per_side = 1 / static_cast<float>(grid.cell_m);  // exact: powers of two
        const float per_height = 1 / static_cast<float>(grid.layer_m);
        const glm::vec3 scale(per_side, per_side, per_height);
        origin_ = (ray.origin - grid.low()) * scale;
        direction_ = ray.direction * scale;
        top_ = static_cast<float>(grid.layers) - 0.5f;
        pitch_ = _mm256_set1_epi32(grid.columns + 2);
        block_columns_ = _mm256_set1_epi32((grid.columns + 1) >> 1);
        block_layers_ = _mm256_set1_epi32((grid.layers + 1) >> 1);
    }

    [[nodiscard]] __m256i at(glm::length_t axis, __m256 distance) const {
        return _mm256_cvttps_epi32(place(axis, distance));
    }
    [[nodiscard]] __m256i layer_at(__m256 distance) const {
        const __m256 above = _mm256_max_ps(place(2, distance), _mm256_setzero_ps());
        return _mm256_cvttps_epi32(_mm256_min_ps(above, _mm256_set1_ps(top_)));
    }
    // All numbers of cells are below 2^15.
    [[nodiscard]] __m256i column(__m256i i, __m256i j) const {
        return _mm256_add_epi32(_mm256_madd_epi16(j, pitch_), i);
    }
    // The lowest block of a column.
    [[nodiscard]] __m256i stack(__m256i i, __m256i j) const {
        const __m256i row = _mm256_madd_epi16(half(j), block_columns_);
        return _mm256_madd_epi16(_mm256_add_epi32(row, half(i)), block_layers_);
    }

  private:
    [[nodiscard]] __m256 place(glm::length_t axis, __m256 distance) const {
        const __m256 way = _mm256_mul_ps(_mm256_set1_ps(direction_[axis]), distance);
        return _mm256_add_ps(_mm256_set1_ps(origin_[axis]), way);
    }

    glm::vec3 origin_, direction_;  // in cells
    float top_;
    __m256i pitch_;
    __m256i block_columns_;
    __m256i block_layers_;
};

}  // namespace

CellWalk::CellWalk(const FootprintGrid& grid)
    : grid_(grid),
      crossed_(static_cast<std::size_t>(grid.columns + 2) * static_cast<std::size_t>(grid.rows + 2)) {}

// What crosses the border by rounding counts for blocks that nobody asks for.
std::size_t CellWalk::block_count() const {
    return grid_.block_count() + static_cast<std::size_t>((grid_.columns + 4) * (grid_.layers + 1) / 2);
}

RayPart CellWalk::within_heights(const trace::Ray& ray, float length_m) const {
    const float low = grid_.low().z;
    const float high = grid_.high().z;
    const float start = ray.origin.z;
    const float end = start + ray.direction.z * length_m;
    if (start >= low && start < high && end >= low && end < high)
        return {0, length_m};
    const RayPart inside = between_planes(low, high, start, ray.direction.z);
    return {std::max(inside.from, 0.0f), std::min(inside.to, length_m)};
}

// Of each point seven blocks and two corners at most.
void CellWalk::make_room(std::size_t points) {
    if (blocks_.size() < 7 * points)
        blocks_.resize(7 * points);
    if (corner_columns_.size() >= corners_ + 2 * points)
        return;
    note_corners();
    const std::size_t size = std::max(corner_columns_.size(), 16 * points);
    corner_columns_.resize(size);
    corner_layers_.resize(size);
}

// Takes points along the ray, a little less than a cell's width apart, eight at once: none waits for the one
// before. Between two of them the ray passes one side of a cell at most in x, and one in y; where it passes
// both, it may have been in either of the two cells at the corner, and is noted in both. Heights in a point's
// cell are those from the point before to the one after.
std::span<const std::int32_t> CellWalk::cross(const trace::Ray& ray, float length_m) {
    const RayPart part = within_heights(ray, length_m);
    if (!(part.from <= part.to))
        return {};
    const float step_m = static_cast<float>(grid_.cell_m) * (1 - 0x1p-7f);
    // A whole number of steps: all distances are exact then, and a point is the same from both sides.
    const float from_m = std::floor(part.from / step_m) * step_m;
    const auto count = static_cast<std::int32_t>((part.to - from_m) / step_m) + 2;
    make_room(static_cast<std::size_t>(count + width));

    const Cells cells(grid_, ray);
    const __m256 step = _mm256_set1_ps(step_m);
    const __m256 from = _mm256_set1_ps(from_m);
    const __m256 to = _mm256_set1_ps(part.to);
    __m256 number = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
    __m256i last_stacks = _mm256_set1_epi32(-1);
    std::int32_t* end = blocks_.data();
    std::int32_t* corner_columns = corner_columns_.data() + corners_;
    std::int32_t* corner_layers = corner_layers_.data() + corners_;
    alignas(32) Lanes columns, lowest, highest;
    for (std::int32_t n = 0; n < count; n += width) {
        // Beyond the end the last point again: it adds nothing.
        const __m256 distance = _mm256_add_ps(from, _mm256_mul_ps(number, step));
        const __m256 before = _mm256_max_ps(_mm256_sub_ps(distance, step), from);
        const __m256 here = _mm256_min_ps(distance, to);
        const __m256 after = _mm256_min_ps(_mm256_add_ps(distance, step), to);
        number = _mm256_add_ps(number, _mm256_set1_ps(width));
        const __m256i i = cells.at(0, here);
        const __m256i j = cells.at(1, here);
        const __m256i next_i = cells.at(0, after);
        const __m256i next_j = cells.at(1, after);
        const __m256i first = cells.layer_at(_mm256_min_ps(before, here));
        const __m256i middle = cells.layer_at(here);
        const __m256i last = cells.layer_at(after);
        const __m256i stacks = cells.stack(i, j);
        store(columns, cells.column(i, j));
        store(lowest, _mm256_min_epi32(first, last));
        store(highest, _mm256_max_epi32(first, last));
        for (std::size_t k = 0; k < width; ++k)
            crossed_[static_cast<std::size_t>(columns[k])] |= layers_between(lowest[k], highest[k]);

        // In a stack that it comes from it was up to here.
        const __m256i first_block = half(first);
        const __m256i middle_block = half(middle);
        const __m256i last_block = half(last);
        const unsigned enters = differing(stacks, predecessors(stacks, last_stacks));
        const unsigned climbs = differing(middle_block, last_block);
        const unsigned climbed = differing(first_block, middle_block);
        end = append(end, _mm256_add_epi32(stacks, last_block), enters | climbs);
        end = append(end, _mm256_add_epi32(stacks, middle_block), enters & climbs);
        end = append(end, _mm256_add_epi32(stacks, first_block), enters & climbed);
        last_stacks = stacks;

        const unsigned corners = differing(i, next_i) & differing(j, next_j);
        const __m256i upper_layers = _mm256_slli_epi32(_mm256_max_epi32(middle, last), 8);
        const __m256i layers = _mm256_or_si256(_mm256_min_epi32(middle, last), upper_layers);
        corner_columns = append(corner_columns, cells.column(i, next_j), corners);
        corner_columns = append(corner_columns, cells.column(next_i, j), corners);
        corner_layers = append(corner_layers, layers, corners);
        corner_layers = append(corner_layers, layers, corners);
        const unsigned stack_corners =
            corners & differing(half(i), half(next_i)) & differing(half(j), half(next_j));
        if (stack_corners == 0)
            continue;
        for (const __m256i corner : {cells.stack(i, next_j), cells.stack(next_i, j)}) {
            end = append(end, _mm256_add_epi32(corner, middle_block), stack_corners);
            end = append(end, _mm256_add_epi32(corner, last_block), stack_corners & climbs);
        }
    }
    corners_ = static_cast<std::size_t>(corner_columns - corner_columns_.data());
    return {blocks_.data(), end};
}

void CellWalk::note_corners() {
    for (std::size_t n = 0; n < corners_; ++n) {
        const std::int32_t layers = corner_layers_[n];
        crossed_[static_cast<std::size_t>(corner_columns_[n])] |= layers_between(layers & 0xFF, layers >> 8);
    }
    corners_ = 0;
}

void CellWalk::merge_into(std::vector<std::uint64_t>& crossed) {
    note_corners();
    const auto pitch = static_cast<std::size_t>(grid_.columns + 2);
    for (std::int32_t j = 0; j < grid_.rows; ++j) {
        const std::uint64_t* row = &crossed_[static_cast<std::size_t>(j) * pitch];
        for (std::int32_t i = 0; i < grid_.columns; ++i)
            crossed[grid_.column(i, j)] |= row[i];
    }
}

}  // namespace drtv::reuse
