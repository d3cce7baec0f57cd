#include "bakerd/bake/footprint_recorder.h"

#include <algorithm>
#include <cmath>

namespace drtv::bake {
namespace {

// A path without any weight still shows in the file's counts.
constexpr float least_share = 0x1p-40f;

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

}  // namespace

FootprintRecorder::FootprintRecorder(const FootprintGrid& grid)
    : grid_(grid), crossed_(static_cast<std::size_t>(grid.columns + 2) * static_cast<std::size_t>(grid.rows + 2)),
      // What crosses the border by rounding counts for blocks that nobody asks for.
      blocks_(grid.block_count() + static_cast<std::size_t>((grid.columns + 4) * (grid.layers + 1) / 2)), most_(blocks_.size() * quarter_count), quarters_(1) {}

void FootprintRecorder::begin(std::size_t quarter) {
    if (++probe_ == 1u << (32 - path_bits)) {
        for (std::size_t n = 0; n < grid_.block_count(); ++n) {
            fold(n);
            blocks_[n].seen = 0;
        }
        probe_ = 1;
        quarters_.resize(1);
    }
    quarters_.push_back(static_cast<std::uint8_t>(quarter));
}

void FootprintRecorder::fold(std::size_t block) {
    std::uint8_t& most = most_[block * quarter_count + quarters_[blocks_[block].seen >> path_bits]];
    most = std::max(most, weight_code(blocks_[block].share));
    blocks_[block].share = 0;
}

FootprintRecorder::Block& FootprintRecorder::current(std::size_t block) {
    if (blocks_[block].seen >> path_bits != probe_) {
        fold(block);
        blocks_[block].seen = probe_ << path_bits;
    }
    return blocks_[block];
}

// Takes points along the ray, footprint_step apart, and at each all heights up to half way to the next. Cheaper than to find each side that the ray crosses, because
// no point waits for the one before; what lies in the map is grown sideways by half a step before it is looked up.
template <class Visit>
void FootprintRecorder::cross(const trace::Ray& ray, float length_m, Visit visit) {
    const glm::vec3 low = grid_.low(), high = grid_.high();
    float from = 0, to = length_m;
    if (const float end = ray.origin.z + ray.direction.z * length_m; ray.origin.z < low.z || ray.origin.z >= high.z || end < low.z || end >= high.z) {
        const Span heights = between(low.z, high.z, ray.origin.z, ray.direction.z);
        from = std::max(heights.from, 0.0f);
        to = std::min(heights.to, length_m);
        if (!(from <= to)) return;
    }
    const float per_side = 1 / static_cast<float>(grid_.cell_m), per_height = 1 / static_cast<float>(grid_.layer_m);  // exact: powers of two
    const float step = static_cast<float>(grid_.cell_m) * footprint_step;
    const glm::vec3 scale(per_side, per_side, per_height), origin = (ray.origin - low) * scale, direction = ray.direction * scale;
    const float rise = std::abs(direction.z) * step / 2, top = static_cast<float>(grid_.layers) - 0.5f;
    const auto count = static_cast<std::int32_t>((to - from) / step) + 2;
    const std::int32_t pitch = grid_.columns + 2, block_columns = (grid_.columns + 1) >> 1, block_layers = (grid_.layers + 1) >> 1;
    std::int32_t last_low = -1, last_high = -1;
    for (std::int32_t n = 0; n < count; ++n) {
        const float distance = std::min(from + static_cast<float>(n) * step, to), height = origin.z + direction.z * distance;
        const auto i = static_cast<std::int32_t>(origin.x + direction.x * distance), j = static_cast<std::int32_t>(origin.y + direction.y * distance);
        const auto lowest = static_cast<std::int32_t>(std::min(std::max(height - rise, 0.0f), top)), highest = static_cast<std::int32_t>(std::min(std::max(height + rise, 0.0f), top));
        crossed_[static_cast<std::size_t>(j * pitch + i)] |= layers_between(lowest, highest);
        const std::int32_t stack = ((j >> 1) * block_columns + (i >> 1)) * block_layers, low_block = stack + (lowest >> 1), high_block = stack + (highest >> 1);
        if (low_block == last_low && high_block == last_high) continue;
        for (std::int32_t block = low_block; block <= high_block; ++block) {
            if (block < last_low || block > last_high) visit(static_cast<std::size_t>(block));
        }
        last_low = low_block;
        last_high = high_block;
    }
}

void FootprintRecorder::path(const trace::Ray& ray, float length_m, float share, std::uint32_t number) {
    const float weight = std::max(share, least_share);
    const std::uint32_t seen = probe_ << path_bits | (number + 1);
    cross(ray, length_m, [&](std::size_t index) {
        Block& block = current(index);
        block.share += block.seen == seen ? 0 : weight;
        block.seen = seen;
    });
}

void FootprintRecorder::lone(const trace::Ray& ray, float share) {
    const float weight = std::max(share, least_share);
    cross(ray, ray.far_m, [&](std::size_t index) { current(index).share += weight; });
}

void FootprintRecorder::merge_into(Footprint& footprint) {
    for (std::int32_t j = 0; j < grid_.rows; ++j) {
        for (std::int32_t i = 0; i < grid_.columns; ++i) footprint.crossed[grid_.column(i, j)] |= crossed_[static_cast<std::size_t>(j) * static_cast<std::size_t>(grid_.columns + 2) + static_cast<std::size_t>(i)];
    }
    for (std::size_t n = 0; n < grid_.block_count(); ++n) fold(n);
    for (std::size_t n = 0; n < footprint.weights.size(); ++n) footprint.weights[n] = std::max(footprint.weights[n], most_[n]);
}

}  // namespace drtv::bake
