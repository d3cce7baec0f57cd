// A tree of boxes over anything that has a box, split by the surface area heuristic in bins (Wald, "On fast
// Construction of SAH-based Bounding Volume Hierarchies", 2007). Boxes are float and too large by more than
// all rounding; what is in them is asked in double, by the caller.
#pragma once

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace drtv::reference {

struct Box {
    std::array<float, 3> low{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
                             std::numeric_limits<float>::infinity()};
    std::array<float, 3> high{-std::numeric_limits<float>::infinity(),
                              -std::numeric_limits<float>::infinity(),
                              -std::numeric_limits<float>::infinity()};

    void extend(const Box& other);
    [[nodiscard]] float half_area() const;
};

class Bvh {
  public:
    // Gives in `order` how the boxes' owners are to be sorted: place n is for the owner of box order[n].
    Bvh(std::span<const Box> boxes, std::vector<std::uint32_t>& order);

    // Calls visit(first, count), roughly nearest first, for places that the ray may meet nearer than `far`,
    // which `visit` may shrink; it returns whether to go on.
    template <class Visit>
    void walk(const glm::dvec3& origin, const glm::dvec3& direction, const double& far, Visit visit) const;

  private:
    // A leaf when `count` > 0: places [first, first + count); else its children are first and first + 1.
    struct Node {
        Box box;
        std::uint32_t first = 0, count = 0;
    };
    struct Ray {
        std::array<float, 3> origin, inverse;
    };
    static constexpr std::size_t max_depth = 96;

    void split(std::span<const Box> boxes, std::vector<std::uint32_t>& order, std::uint32_t node,
               std::size_t depth);
    [[nodiscard]] static float entry(const Box& box, const Ray& ray, float far);

    std::vector<Node> nodes_;
};

// Where the ray enters the box, or infinity.
inline float Bvh::entry(const Box& box, const Ray& ray, float far) {
    float enter = 0, leave = far;
    for (std::size_t k = 0; k < 3; ++k) {
        const float a = (box.low[k] - ray.origin[k]) * ray.inverse[k],
                    b = (box.high[k] - ray.origin[k]) * ray.inverse[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave * 1.000002f ? enter : std::numeric_limits<float>::infinity();
}

template <class Visit>
void Bvh::walk(const glm::dvec3& origin, const glm::dvec3& direction, const double& far, Visit visit) const {
    if (nodes_.empty())
        return;
    Ray ray;
    for (std::size_t k = 0; k < 3; ++k) {
        const double d = direction[static_cast<glm::length_t>(k)];
        ray.origin[k] = static_cast<float>(origin[static_cast<glm::length_t>(k)]);
        ray.inverse[k] =
            static_cast<float>(1 / (std::abs(d) < 1e-18 ? 1e-18 : d));  // so that nothing is 0 times infinity
    }
    const auto bound = [&] { return static_cast<float>(std::min(far, 1e30) * 1.000001); };
    struct Pending {
        std::uint32_t node;
        float enter;
    };
    std::array<Pending, max_depth + 4> stack;
    std::size_t depth = 0;
    stack[depth++] = {0, entry(nodes_[0].box, ray, bound())};
    while (depth > 0) {
        const Pending next = stack[--depth];
        if (!(next.enter <= bound()))
            continue;
        const Node* node = &nodes_[next.node];
        while (node->count == 0) {
            const float limit = bound();
            const float a = entry(nodes_[node->first].box, ray, limit),
                        b = entry(nodes_[node->first + 1].box, ray, limit);
            const std::uint32_t nearer = a <= b ? node->first : node->first + 1,
                                farther = a <= b ? node->first + 1 : node->first;
            if (!(std::min(a, b) <= limit)) {
                node = nullptr;
                break;
            }
            if (std::max(a, b) <= limit)
                stack[depth++] = {farther, std::max(a, b)};
            node = &nodes_[nearer];
        }
        if (node != nullptr && !visit(node->first, node->count))
            return;
    }
}

}  // namespace drtv::reference
