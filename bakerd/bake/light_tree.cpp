#include "bakerd/bake/light_tree.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace drtv::bake {
namespace {

glm::length_t longest_axis(const glm::vec3& extent) {
    if (extent.x >= extent.y && extent.x >= extent.z)
        return 0;
    return extent.y >= extent.z ? 1 : 2;
}

}  // namespace

LightTree::LightTree(const LightSet& lights, const glm::vec3& centre, float reach_m) {
    std::vector<Node> leaves;
    for (const StaticPointLight* point : lights.points) {
        if (glm::length(point->position - centre) > reach_m)
            continue;
        points_.push_back(point);
        leaves.push_back({point->position, 0, luminance(point->intensity), -1, -1, -1, {point, nullptr}});
    }
    for (const EmissiveObject* emissive : lights.emissive) {
        if (glm::length(emissive->centre - centre) - emissive->radius_m > reach_m)
            continue;
        leaves.push_back(
            {emissive->centre, emissive->radius_m, emissive->power, -1, -1, -1, {nullptr, emissive}});
    }
    if (leaves.empty())
        return;
    nodes_.reserve(2 * leaves.size());
    build(leaves, -1);
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
        if (nodes_[n].item.emissive != nullptr)
            leaf_of_object_.emplace_back(nodes_[n].item.emissive->object, static_cast<std::int32_t>(n));
    }
    std::ranges::sort(leaf_of_object_);
}

// Halves along the longest axis.
std::int32_t LightTree::build(std::span<Node> leaves, std::int32_t parent) {
    const auto index = static_cast<std::int32_t>(nodes_.size());
    if (leaves.size() == 1) {
        nodes_.push_back(leaves[0]);
        nodes_.back().parent = parent;
        return index;
    }
    map::Bounds bounds;
    map::Bounds centres;
    Node node;
    node.parent = parent;
    for (const Node& leaf : leaves) {
        bounds.extend(leaf.centre - leaf.radius_m);
        bounds.extend(leaf.centre + leaf.radius_m);
        centres.extend(leaf.centre);
        node.power += leaf.power;
    }
    node.centre = (bounds.low + bounds.high) * 0.5f;
    node.radius_m = glm::length(bounds.high - bounds.low) * 0.5f;
    const glm::length_t axis = longest_axis(centres.high - centres.low);
    std::ranges::stable_sort(leaves, {}, [axis](const Node& leaf) { return leaf.centre[axis]; });
    nodes_.push_back(node);
    const std::size_t middle = leaves.size() / 2;
    const std::int32_t left = build(leaves.first(middle), index);
    const std::int32_t right = build(leaves.subspan(middle), index);
    Node& built = nodes_[static_cast<std::size_t>(index)];
    built.left = left;
    built.right = right;
    return index;
}

float LightTree::share_of_left(const Node& node, const glm::vec3& from) const {
    const Node& left = nodes_[static_cast<std::size_t>(node.left)];
    const Node& right = nodes_[static_cast<std::size_t>(node.right)];
    const auto square = [&](const Node& child) {
        const glm::vec3 d = child.centre - from;
        return std::max(
            {glm::dot(d, d), child.radius_m * child.radius_m, min_light_distance_m * min_light_distance_m});
    };
    const float of_left = left.power * square(right);
    const float of_right = right.power * square(left);
    // Never quite 0 or 1: no light is left out.
    return std::clamp(of_left / (of_left + of_right), 0.01f, 0.99f);
}

LightTree::Drawn LightTree::draw(const glm::vec3& from, double u, const Roulette& roulette) const {
    Drawn drawn;
    drawn.probability = 1;
    const Node* node = nodes_.data();
    for (;;) {
        // Given up as soon as the rest of the tree cannot matter.
        const glm::vec3 way = node->centre - from;
        const float squared = glm::dot(way, way);
        if (squared > node->radius_m * node->radius_m) {
            const float distance_m = std::max(std::sqrt(squared) - node->radius_m, min_light_distance_m);
            const float scaled = roulette.faint * distance_m * distance_m * drawn.probability;
            if (node->power < drawn.survival * scaled)
                drawn.survival = node->power / scaled;
            if (roulette.number >= drawn.survival) {
                drawn.probability = 0;
                return drawn;
            }
        }
        if (node->left < 0)
            break;
        const double share = share_of_left(*node, from);
        const bool left = u < share;
        u = std::clamp(left ? u / share : (u - share) / (1 - share), 0.0, 1 - 0x1p-32);
        drawn.probability *= static_cast<float>(left ? share : 1 - share);
        node = &nodes_[static_cast<std::size_t>(left ? node->left : node->right)];
    }
    drawn.item = node->item;
    drawn.rest = u;
    return drawn;
}

LightTree::Drawn LightTree::find(const glm::vec3& from, std::uint32_t object) const {
    const auto leaf =
        std::ranges::lower_bound(leaf_of_object_, object, {}, &std::pair<std::uint32_t, std::int32_t>::first);
    if (leaf == leaf_of_object_.end() || leaf->first != object)
        return {};
    Drawn drawn;
    drawn.item = nodes_[static_cast<std::size_t>(leaf->second)].item;
    drawn.probability = 1;
    for (std::int32_t n = leaf->second; nodes_[static_cast<std::size_t>(n)].parent >= 0;) {
        const std::int32_t parent = nodes_[static_cast<std::size_t>(n)].parent;
        const Node& node = nodes_[static_cast<std::size_t>(parent)];
        const float share = share_of_left(node, from);
        drawn.probability *= n == node.left ? share : 1 - share;
        n = parent;
    }
    return drawn;
}

}  // namespace drtv::bake
