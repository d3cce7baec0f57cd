#include "tests/reference/reference_bvh.h"

#include <numeric>

namespace drtv::reference {
namespace {

constexpr std::uint32_t bins = 16, small_leaf = 3, largest_leaf = 12;
constexpr float step_cost = 1.2f;  // of a box against a triangle
// A float holds a coordinate to 6e-8 of it, and the ray's origin likewise.
constexpr float padding = 5e-7f;

float centre(const Box& box, std::size_t axis) {
    return box.low[axis] + box.high[axis];
}  // twice

struct Cut {
    std::size_t axis = 0;
    std::uint32_t bin = 0;  // those below it go left
    float cost = std::numeric_limits<float>::infinity();
};

// Which bin a centre falls into.
struct Binning {
    float low, scale;
    [[nodiscard]] std::uint32_t operator()(float c) const {
        return std::min(bins - 1, static_cast<std::uint32_t>(std::max(0.0f, (c - low) * scale)));
    }
};

Binning binning(float low, float high) {
    return {low, static_cast<float>(bins) / (high - low)};
}

Cut cheapest_cut(std::span<const Box> boxes, std::span<const std::uint32_t> order, const Box& centres) {
    Cut best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(centres.high[axis] > centres.low[axis]))
            continue;
        const Binning bin = binning(centres.low[axis], centres.high[axis]);
        std::array<Box, bins> box{};
        std::array<std::uint32_t, bins> count{};
        for (const std::uint32_t n : order) {
            const std::uint32_t at = bin(centre(boxes[n], axis));
            box[at].extend(boxes[n]);
            ++count[at];
        }
        std::array<float, bins> right_cost{};
        Box right, left;
        std::uint32_t right_count = 0, left_count = 0;
        for (std::uint32_t k = bins - 1; k > 0; --k) {
            right.extend(box[k]);
            right_count += count[k];
            right_cost[k] = right_count == 0 ? std::numeric_limits<float>::infinity()
                                             : right.half_area() * static_cast<float>(right_count);
        }
        for (std::uint32_t k = 1; k < bins; ++k) {
            left.extend(box[k - 1]);
            left_count += count[k - 1];
            if (left_count == 0)
                continue;
            const float cost = left.half_area() * static_cast<float>(left_count) + right_cost[k];
            if (cost < best.cost)
                best = {axis, k, cost};
        }
    }
    return best;
}

}  // namespace

void Box::extend(const Box& other) {
    for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], other.low[k]);
        high[k] = std::max(high[k], other.high[k]);
    }
}

float Box::half_area() const {
    const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x * y + y * z + z * x;
}

Bvh::Bvh(std::span<const Box> boxes, std::vector<std::uint32_t>& order) {
    order.resize(boxes.size());
    std::iota(order.begin(), order.end(), 0u);
    if (boxes.empty())
        return;
    nodes_.reserve(boxes.size());
    nodes_.push_back({{}, 0, static_cast<std::uint32_t>(boxes.size())});
    split(boxes, order, 0, 0);
    float largest = 0;
    for (std::size_t k = 0; k < 3; ++k)
        largest = std::max({largest, std::abs(nodes_[0].box.low[k]), std::abs(nodes_[0].box.high[k])});
    for (Node& node : nodes_) {
        for (std::size_t k = 0; k < 3; ++k) {
            node.box.low[k] -= padding * largest;
            node.box.high[k] += padding * largest;
        }
    }
}

void Bvh::split(std::span<const Box> boxes, std::vector<std::uint32_t>& order, std::uint32_t node,
                std::size_t depth) {
    const std::uint32_t first = nodes_[node].first, count = nodes_[node].count;
    const std::span<std::uint32_t> mine = std::span(order).subspan(first, count);
    Box box, centres;
    for (const std::uint32_t n : mine) {
        box.extend(boxes[n]);
        Box c;
        for (std::size_t k = 0; k < 3; ++k)
            c.low[k] = c.high[k] = centre(boxes[n], k);
        centres.extend(c);
    }
    nodes_[node].box = box;
    if (count <= small_leaf)
        return;
    std::uint32_t left = count / 2;
    const Cut cut = depth < max_depth / 2 ? cheapest_cut(boxes, mine, centres) : Cut{};
    if (cut.cost + step_cost * box.half_area() >= box.half_area() * static_cast<float>(count) &&
        count <= largest_leaf)
        return;
    if (cut.bin > 0) {
        const Binning bin = binning(centres.low[cut.axis], centres.high[cut.axis]);
        const auto middle = std::partition(mine.begin(), mine.end(), [&](std::uint32_t n) {
            return bin(centre(boxes[n], cut.axis)) < cut.bin;
        });
        left = static_cast<std::uint32_t>(middle - mine.begin());
    }
    if (left == 0 || left == count)
        left = count / 2;
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].first = child;
    nodes_[node].count = 0;
    nodes_.push_back({{}, first, left});
    nodes_.push_back({{}, first + left, count - left});
    split(boxes, order, child, depth + 1);
    split(boxes, order, child + 1, depth + 1);
}

}  // namespace drtv::reference
