#include "bakerd/map/node_import.h"

#include "bakerd/map/light_import.h"
#include "bakerd/map/mesh_import.h"
#include "bakerd/map/mesh_placement.h"
#include "bakerd/map/named_groups.h"
#include "bakerd/map/node_role.h"
#include "bakerd/map/node_transform.h"
#include "bakerd/map/node_tree.h"
#include "bakerd/map/property_check.h"
#include "bakerd/map/warning.h"

#include <fmt/format.h>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace drtv::map {
namespace {

// glTF (x, y, z) is world (x, -z, y).
const glm::dmat4 world_from_gltf(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);

// Beyond it no sector can be named, and a probe's place has no number in a sector file.
constexpr double max_probe_m = 1'048'576;

bool is_finite(const glm::dmat4& m) {
    for (glm::length_t c = 0; c < 4; ++c) {
        for (glm::length_t r = 0; r < 4; ++r) {
            if (!(std::abs(m[c][r]) < 1e30))
                return false;
        }
    }
    return true;
}

// A node on its way, in the frame of its parent, with the purpose that it inherits.
struct Pending {
    int node;
    glm::dmat4 world_from_parent;
    NodePurpose purpose;
    int group_node = -1;  // that gave it its light group
    int role_node = -1;   // that gave it its role
    bool hidden = false;  // what would be seen of it, or shine, is not there: probes and volumes are helpers
};

class NodeImporter {
  public:
    NodeImporter(const ImportState& state, const MaterialIndices& materials)
        : state_(state),
          model_(state.document.model),
          placer_(state.map, state.shared),
          meshes_(state, materials),
          coarser_(coarser_levels(model_)) {}

    Imported run() {
        // A stack of our own: a chain of nodes may be deeper than the thread's stack.
        std::vector<Pending> stack;
        push(stack, root_nodes(model_), {-1, world_from_gltf, {}});
        while (!stack.empty()) {
            Pending pending = std::move(stack.back());
            stack.pop_back();
            const tinygltf::Node& node = at_index(model_.nodes, pending.node);
            const auto local = local_transform(node);
            if (!local)
                return fail(pending.node, local.error());
            const glm::dmat4 world_from_node = pending.world_from_parent * *local;
            if (!is_finite(world_from_node))
                return fail(pending.node, "its transform is not finite");
            if (auto read = read_purpose(node, pending.purpose); !read)
                return fail(pending.node, read.error());
            if (has_light_group(node)) {
                const bool ends = pending.purpose.light_group.empty();
                pending.group_node = ends ? -1 : pending.node;
                if (!ends)
                    groups_.add(pending.node, pending.purpose.light_group);
            }
            if (has_role(node))
                pending.role_node = pending.node;
            if (pending.purpose.role == NodeRole::ignore && has_role(node))
                ++state_.map.ignored_nodes;
            pending.hidden = pending.hidden || is_hidden(node);
            if (auto imported = import_node(pending, world_from_node); !imported)
                return imported;
            push(stack,
                 node.children,
                 {-1,
                  world_from_node,
                  pending.purpose,
                  pending.group_node,
                  pending.role_node,
                  pending.hidden});
        }
        for (const auto& [node, count] : meshes_of_probe_)
            warn(state_.map, state_.document.at(shown(node) + ": " + inherited_probe(count)));
        for (const std::string& sentence : unheard_properties(model_))
            warn(state_.map, state_.document.at(sentence));
        groups_.tell_unused([&](int node, const std::string& group) {
            warn(state_.map,
                 state_.document.at(
                     shown(node) +
                     fmt::format(": light_group '{}' is of no use: nothing there shines", group)));
        });
        return {};
    }

  private:
    // The first node comes off the stack first. `from` is what they inherit.
    void push(std::vector<Pending>& stack, const std::vector<int>& nodes, const Pending& from) const {
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
            if (coarser_[static_cast<std::size_t>(*node)])
                continue;
            stack.push_back(from);
            stack.back().node = *node;
        }
    }

    [[nodiscard]] std::string shown(int node) const {
        const std::string& name = at_index(model_.nodes, node).name;
        return name.empty() ? fmt::format("node {}", node) : fmt::format("node {} ('{}')", node, name);
    }

    [[nodiscard]] tl::unexpected<std::string> fail(int node, const std::string& rest) const {
        return tl::unexpected(state_.document.at(shown(node) + ": " + rest));
    }

    Imported import_node(const Pending& pending, const glm::dmat4& world_from_node) {
        if (pending.purpose.role == NodeRole::ignore)
            return {};
        const tinygltf::Node& node = at_index(model_.nodes, pending.node);
        if (!pending.hidden) {
            if (auto light = add_light(pending, world_from_node); !light)
                return light;
        }
        if (pending.purpose.role == NodeRole::probe) {
            if (node.mesh >= 0 && pending.role_node != pending.node)
                ++meshes_of_probe_[pending.role_node];
            return add_probe(pending.node, world_from_node);
        }
        if (node.mesh < 0 || (pending.hidden && !is_volume(pending.purpose.role)))
            return {};
        const auto mesh = meshes_.index_of(node);
        if (!mesh)
            return tl::unexpected(mesh.error());
        // Its vertices stand in the scene's axes already.
        const glm::dmat4& world_from_mesh = node.skin >= 0 ? world_from_gltf : world_from_node;
        if (*mesh == no_mesh)
            return {};
        if (pending.purpose.role == NodeRole::spacing && shines(state_.map.meshes[*mesh], state_.map))
            warn(state_.map, state_.document.at(shown(pending.node) + ": " + dark_volume));
        if (pending.group_node >= 0 && !is_volume(pending.purpose.role) &&
            shines(state_.map.meshes[*mesh], state_.map))
            groups_.add_light(pending.group_node);
        const auto instancing = node.extensions.find("EXT_mesh_gpu_instancing");
        if (instancing != node.extensions.end())
            return place_instances(pending, {*mesh, world_from_mesh, node.name}, instancing->second);
        if (auto counted = placer_.count(*mesh, pending.purpose, 1); !counted)
            return fail(pending.node, counted.error());
        return place(pending, {*mesh, world_from_mesh, node.name});
    }

    Imported place(const Pending& pending, MeshPlace place) {
        if (is_volume(pending.purpose.role) || pending.purpose.spacing_m > 0)
            place.where = state_.document.at(shown(pending.node));
        if (auto placed = placer_.place(std::move(place), pending.purpose); !placed)
            return fail(pending.node, placed.error());
        return {};
    }

    // `base` is where the node itself stands.
    Imported place_instances(const Pending& pending,
                             const MeshPlace& base,
                             const tinygltf::Value& instancing) {
        const auto transforms = instance_transforms(state_.document, instancing);
        if (!transforms)
            return fail(pending.node, "EXT_mesh_gpu_instancing: " + transforms.error());
        if (auto counted = placer_.count(base.mesh, pending.purpose, transforms->size()); !counted)
            return fail(pending.node, counted.error());
        for (std::size_t n = 0; n < transforms->size(); ++n) {
            const glm::dmat4 world_from_instance = base.world_from_object * (*transforms)[n];
            if (!is_finite(world_from_instance))
                return fail(pending.node, fmt::format("the transform of instance {} is not finite", n));
            const std::string name = fmt::format("{}[{}]", base.name, n);
            if (auto placed = place(pending, {base.mesh, world_from_instance, name}); !placed)
                return placed;
        }
        return {};
    }

    Imported add_probe(int node, const glm::dmat4& world_from_node) {
        const glm::dvec3 position(world_from_node[3]);
        if (is_far(position))
            return fail(node, far_sentence);
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            const double distance_m = std::abs(position[axis]);
            if (distance_m > max_probe_m)
                return fail(node,
                            fmt::format("a probe stands {:.0f} m from the origin, over the limit of {:.0f}",
                                        distance_m,
                                        max_probe_m));
        }
        const std::string& name = at_index(model_.nodes, node).name;
        state_.map.probes.push_back({position + 0.0, name});  // no negative zeros
        return {};
    }

    Imported add_light(const Pending& pending, const glm::dmat4& world_from_node) {
        const int index = pending.node;
        const tinygltf::Node& node = at_index(model_.nodes, index);
        const auto found = node.extensions.find("KHR_lights_punctual");
        if (found == node.extensions.end())
            return {};
        const int number = found->second.Get("light").GetNumberAsInt();  // checked with the document
        auto light = import_light(model_, number);
        if (!light)
            return fail(index, light.error());
        if (is_far(world_from_node[3]))
            return fail(index, far_sentence);
        light->position = glm::vec3(world_from_node[3]);
        const glm::dvec3 shines = -glm::dvec3(world_from_node[2]);  // along the node's -z
        light->direction = glm::length(shines) > 0 ? glm::vec3(glm::normalize(shines)) : glm::vec3(0, 0, -1);
        light->name = node.name;
        light->light_group = light_group_of(pending.purpose.light_group, state_.map);
        groups_.add_light(pending.group_node);
        if (const std::string doubt = doubt_about(*light); !doubt.empty())
            warn(state_.map, state_.document.at(doubt));
        state_.map.lights.push_back(std::move(*light));
        return {};
    }

    const ImportState& state_;
    const tinygltf::Model& model_;
    MeshPlacer placer_;
    MeshImporter meshes_;
    const std::vector<bool> coarser_;  // by node
    NamedGroups groups_;
    std::map<int, std::size_t> meshes_of_probe_;  // that inherit its role, by the node that has it
};

}  // namespace

Imported import_nodes(const ImportState& state, const MaterialIndices& materials) {
    return NodeImporter(state, materials).run();
}

}  // namespace drtv::map
