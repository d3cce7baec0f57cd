#include "bakerd/map/node_tree_check.h"

#include <cstdint>
#include <vector>

namespace drtv::map {
namespace {

constexpr std::size_t no_parent = SIZE_MAX;
using Parents = std::vector<std::size_t>;  // by node

CheckResult find_parents(const Json& nodes, Parents& parent) {
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const auto children = nodes[n].find("children");
        if (children == nodes[n].end())
            continue;
        for (const Json& child : *children) {
            const auto c = child.get<std::size_t>();
            if (parent[c] != no_parent)
                return wrong("node {} has two parents, {} and {}", c, parent[c], n);
            parent[c] = n;
        }
    }
    return {};
}

CheckResult find_cycle(const Parents& parent) {
    // 0: not seen, else the walk that saw it first; meeting one's own walk again is a cycle.
    std::vector<std::size_t> seen_in(parent.size(), 0);
    for (std::size_t n = 0; n < parent.size(); ++n) {
        const std::size_t walk = n + 1;
        for (std::size_t at = n; at != no_parent && seen_in[at] == 0; at = parent[at]) {
            seen_in[at] = walk;
            const std::size_t above = parent[at];
            if (above != no_parent && seen_in[above] == walk)
                return wrong("node {} is its own ancestor: the node graph has a cycle", above);
        }
    }
    return {};
}

CheckResult check_scene_roots(const Json& scenes, const Parents& parent) {
    std::vector<std::size_t> root_of(parent.size(), 0);  // scene + 1
    std::size_t scene_number = 0;
    for (const Json& scene : scenes) {
        ++scene_number;
        if (!scene.contains("nodes"))
            continue;
        for (const Json& node : scene["nodes"]) {
            const auto n = node.get<std::size_t>();
            if (parent[n] != no_parent)
                return wrong("scene {}: node {} is not a root, it is a child of node {}",
                             scene_number - 1,
                             n,
                             parent[n]);
            if (root_of[n] == scene_number)
                return wrong("scene {}: node {} stands there twice", scene_number - 1, n);
            root_of[n] = scene_number;
        }
    }
    return {};
}

}  // namespace

CheckResult check_node_tree(const Json& root) {
    const auto nodes = root.find("nodes");
    if (nodes == root.end())
        return {};
    Parents parent(nodes->size(), no_parent);
    if (CheckResult checked = find_parents(*nodes, parent); !checked)
        return checked;
    if (CheckResult checked = find_cycle(parent); !checked)
        return checked;
    const auto scenes = root.find("scenes");
    return scenes == root.end() ? CheckResult() : check_scene_roots(*scenes, parent);
}

}  // namespace drtv::map
