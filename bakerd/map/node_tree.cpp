#include "bakerd/map/node_tree.h"

#include "bakerd/map/gltf_document.h"

#include <algorithm>

namespace drtv::map {

std::vector<bool> coarser_levels(const tinygltf::Model& model) {
    std::vector<bool> coarser(model.nodes.size(), false);
    for (std::size_t finest = 0; finest < coarser.size(); ++finest) {
        const auto levels = model.nodes[finest].extensions.find("MSFT_lod");
        if (levels == model.nodes[finest].extensions.end())
            continue;
        const tinygltf::Value& ids = levels->second.Get("ids");
        for (int n = 0; n < static_cast<int>(ids.ArrayLen()); ++n) {
            const auto level = static_cast<std::size_t>(ids.Get(n).GetNumberAsInt());
            if (level != finest)
                coarser[level] = true;
        }
    }
    return coarser;
}

bool is_hidden(const tinygltf::Node& node) {
    const auto visibility = node.extensions.find("KHR_node_visibility");
    return visibility != node.extensions.end() && visibility->second.Has("visible") &&
           !visibility->second.Get("visible").Get<bool>();
}

std::vector<int> root_nodes(const tinygltf::Model& model) {
    if (!model.scenes.empty())
        return at_index(model.scenes, std::max(model.defaultScene, 0)).nodes;
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes) {
        for (int child : node.children)
            is_child[static_cast<std::size_t>(child)] = true;
    }
    std::vector<int> roots;
    for (std::size_t n = 0; n < is_child.size(); ++n) {
        if (!is_child[n])
            roots.push_back(static_cast<int>(n));
    }
    return roots;
}

}  // namespace drtv::map
