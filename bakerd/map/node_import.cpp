#include "bakerd/map/import_parts.h"

#include "bakerd/map/node_transform.h"

#include <fmt/format.h>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace drtv::map {
namespace {

// glTF (x, y, z) is world (x, -z, y).
const glm::dmat4 world_from_gltf(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);

enum class NodeRole { fixed, vegetation, ignore, probe, no_probes, interior };

constexpr double max_distance_m = 1e9;
// Instancing lets a small file ask for much: objects, vertices that their bounds must visit, and vertices
// that volumes and flattened meshes copy. All far above any real map.
constexpr std::size_t max_objects = std::size_t{1} << 22, max_placed_vertices = std::size_t{1} << 32,
                      max_copied_vertices = std::size_t{1} << 26;

struct RoleName {
    const char* name;
    NodeRole role;
};
constexpr std::array<RoleName, 6> role_names = {{{"static", NodeRole::fixed},
                                                 {"vegetation", NodeRole::vegetation},
                                                 {"ignore", NodeRole::ignore},
                                                 {"probe", NodeRole::probe},
                                                 {"no_probes", NodeRole::no_probes},
                                                 {"interior", NodeRole::interior}}};

struct Pending {
    std::size_t node;
    glm::dmat4 world_from_parent;
    NodeRole role;
    std::string bake_probe;
};

class NodeImporter {
  public:
    NodeImporter(const GltfDocument& document, const MaterialIndices& materials, Map& map, Shared& shared)
        : document_(document),
          model_(document.model),
          materials_(materials),
          map_(map),
          shared_(shared),
          mesh_of_(model_.meshes.size()) {}

    Imported run() {
        // A stack of our own: a chain of nodes may be deeper than the thread's stack.
        std::vector<Pending> stack;
        const std::vector<std::size_t> roots = root_nodes();
        for (auto node = roots.rbegin(); node != roots.rend(); ++node)
            stack.push_back({*node, world_from_gltf, NodeRole::fixed, ""});
        while (!stack.empty()) {
            Pending pending = std::move(stack.back());
            stack.pop_back();
            const auto local = local_transform(model_.nodes[pending.node]);
            if (!local)
                return fail(pending.node, local.error());
            const glm::dmat4 world_from_node = pending.world_from_parent * *local;
            if (!finite(world_from_node))
                return fail(pending.node, "its transform is not finite");
            if (auto role = read_role(pending); !role)
                return role;
            if (auto imported = import_node(pending, world_from_node); !imported)
                return imported;
            const std::vector<int>& children = model_.nodes[pending.node].children;
            for (auto child = children.rbegin(); child != children.rend(); ++child) {
                stack.push_back(
                    {static_cast<std::size_t>(*child), world_from_node, pending.role, pending.bake_probe});
            }
        }
        return {};
    }

  private:
    [[nodiscard]] std::string name_of(std::size_t node) const {
        const std::string& name = model_.nodes[node].name;
        return name.empty() ? fmt::format("node {}", node) : fmt::format("node {} ('{}')", node, name);
    }

    [[nodiscard]] tl::unexpected<std::string> fail(std::size_t node, const std::string& rest) const {
        return tl::unexpected(document_.at(name_of(node) + ": " + rest));
    }

    static bool finite(const glm::dmat4& m) {
        for (glm::length_t c = 0; c < 4; ++c) {
            for (glm::length_t r = 0; r < 4; ++r) {
                if (!(std::abs(m[c][r]) < 1e30))
                    return false;
            }
        }
        return true;
    }

    // The default scene's roots; of a file without scenes, all nodes that are nobody's child.
    [[nodiscard]] std::vector<std::size_t> root_nodes() const {
        std::vector<std::size_t> roots;
        if (!model_.scenes.empty()) {
            const int scene = model_.defaultScene >= 0 ? model_.defaultScene : 0;
            for (int node : model_.scenes[static_cast<std::size_t>(scene)].nodes)
                roots.push_back(static_cast<std::size_t>(node));
            return roots;
        }
        std::vector<bool> is_child(model_.nodes.size(), false);
        for (const tinygltf::Node& node : model_.nodes) {
            for (int child : node.children)
                is_child[static_cast<std::size_t>(child)] = true;
        }
        for (std::size_t n = 0; n < is_child.size(); ++n) {
            if (!is_child[n])
                roots.push_back(n);
        }
        return roots;
    }

    Imported read_role(Pending& pending) const {
        const tinygltf::Value& extras = model_.nodes[pending.node].extras;
        if (!extras.IsObject())
            return {};
        if (extras.Has("bake_role")) {
            const tinygltf::Value& value = extras.Get("bake_role");
            if (!value.IsString())
                return fail(pending.node, "bake_role must be a string");
            const std::string& text = value.Get<std::string>();
            const auto found = std::find_if(
                role_names.begin(), role_names.end(), [&](const RoleName& r) { return text == r.name; });
            if (found == role_names.end())
                return fail(
                    pending.node,
                    fmt::format(
                        "bake_role '{}' is not one of static, vegetation, ignore, probe, no_probes, interior",
                        text));
            pending.role = found->role;
        }
        if (extras.Has("bake_probe")) {
            const tinygltf::Value& value = extras.Get("bake_probe");
            if (!value.IsString())
                return fail(pending.node, "bake_probe must be a string");
            pending.bake_probe = value.Get<std::string>();
        }
        return {};
    }

    Imported import_node(const Pending& pending, const glm::dmat4& world_from_node) {
        if (pending.role == NodeRole::ignore)
            return {};
        const tinygltf::Node& node = model_.nodes[pending.node];
        if (auto light = add_light(pending.node, world_from_node); !light)
            return light;
        if (pending.role == NodeRole::probe) {
            if (is_far(world_from_node[3]))
                return fail_far(pending.node);
            // Beyond it no sector can be named, and its place has no number in a sector file.
            constexpr double max_probe_m = 1'048'576;
            for (glm::length_t axis = 0; axis < 3; ++axis) {
                if (std::abs(world_from_node[3][axis]) > max_probe_m)
                    return fail(
                        pending.node,
                        fmt::format("a probe stands {:.0f} m from the origin, over the limit of {:.0f}",
                                    std::abs(world_from_node[3][axis]),
                                    max_probe_m));
            }
            map_.probes.push_back({glm::dvec3(world_from_node[3]) + 0.0, node.name});  // no negative zeros
            return {};
        }
        if (node.mesh < 0)
            return {};
        const auto mesh = mesh_index(static_cast<std::size_t>(node.mesh));
        if (!mesh)
            return tl::unexpected(mesh.error());
        if (*mesh == no_mesh)
            return {};
        const auto instancing = node.extensions.find("EXT_mesh_gpu_instancing");
        if (instancing == node.extensions.end()) {
            if (auto counted = count_placed(pending, *mesh, 1); !counted)
                return counted;
            return place(pending, *mesh, world_from_node, node.name);
        }
        const auto transforms = instance_transforms(document_, instancing->second);
        if (!transforms)
            return fail(pending.node, "EXT_mesh_gpu_instancing: " + transforms.error());
        if (auto counted = count_placed(pending, *mesh, transforms->size()); !counted)
            return counted;
        for (std::size_t n = 0; n < transforms->size(); ++n) {
            const glm::dmat4 world_from_instance = world_from_node * (*transforms)[n];
            if (!finite(world_from_instance))
                return fail(pending.node, fmt::format("the transform of instance {} is not finite", n));
            if (auto placed = place(pending, *mesh, world_from_instance, fmt::format("{}[{}]", node.name, n));
                !placed)
                return placed;
        }
        return {};
    }

    static bool is_far(const glm::dvec3& position) { return !(glm::length(position) < max_distance_m); }

    [[nodiscard]] tl::unexpected<std::string> fail_far(std::size_t node) const {
        return fail(node, "it reaches farther than 10^9 m from the origin");
    }

    [[nodiscard]] std::size_t vertices_of(std::uint32_t mesh) const {
        std::size_t vertices = 0;
        for (const Primitive& primitive : map_.meshes[mesh].primitives)
            vertices += primitive.positions.size();
        return vertices;
    }

    Imported count_placed(const Pending& pending, std::uint32_t mesh, std::size_t instances) {
        if (is_volume(pending.role))
            return count_copied(pending.node, mesh, instances);
        placed_vertices_ += instances * vertices_of(mesh);
        if (map_.objects.size() + instances > max_objects)
            return fail(
                pending.node,
                fmt::format("with its instances the map has over {} objects, the limit", max_objects));
        if (placed_vertices_ > max_placed_vertices)
            return fail(pending.node,
                        fmt::format("with its instances the file places {} vertices, over the limit of {}",
                                    placed_vertices_,
                                    max_placed_vertices));
        return {};
    }

    Imported count_copied(std::size_t node, std::uint32_t mesh, std::size_t instances) {
        copied_vertices_ += instances * vertices_of(mesh);
        if (copied_vertices_ > max_copied_vertices)
            return fail(
                node,
                fmt::format("volumes and flat objects up to it have {} vertices, over the limit of {}",
                            copied_vertices_,
                            max_copied_vertices));
        return {};
    }

    static bool is_volume(NodeRole role) { return role == NodeRole::no_probes || role == NodeRole::interior; }

    tl::expected<std::uint32_t, std::string> mesh_index(std::size_t gltf_mesh) {
        std::optional<std::uint32_t>& known = mesh_of_[gltf_mesh];
        if (!known) {
            const auto imported = import_mesh(document_, gltf_mesh, materials_, map_, shared_);
            if (!imported)
                return imported;
            known = *imported;
        }
        return *known;
    }

    Imported place(const Pending& pending,
                   std::uint32_t mesh,
                   const glm::dmat4& world_from_object,
                   std::string name) {
        if (is_volume(pending.role))
            return add_volume(pending, mesh, world_from_object, std::move(name));
        Object object;
        object.mesh = mesh;
        object.role = pending.role == NodeRole::vegetation ? Role::vegetation : Role::fixed;
        object.world_from_object = glm::mat4x3(glm::dmat4x3(world_from_object));
        object.name = as_sentence(std::move(name));  // it is shown to people
        const double volume = std::abs(glm::determinant(glm::dmat3(world_from_object)));
        const double side = std::max({glm::length(glm::dvec3(world_from_object[0])),
                                      glm::length(glm::dvec3(world_from_object[1])),
                                      glm::length(glm::dvec3(world_from_object[2]))});
        if (volume <= 1e-9 * side * side * side) {
            // Scaled flat: the inverse that instancing needs does not exist, so the surface gets a mesh of
            // its own.
            if (auto counted = count_copied(pending.node, mesh, 1); !counted)
                return counted;
            object.mesh = flattened_mesh(mesh, object.world_from_object);
            object.world_from_object = glm::mat4x3(1);
        }
        for (const Primitive& primitive : map_.meshes[object.mesh].primitives) {
            for (const glm::vec3& position : primitive.positions) {
                const glm::vec3 corner = object.world_from_object * glm::vec4(position, 1);
                if (is_far(corner))
                    return fail_far(pending.node);  // NaN is far too, and bounds would not show it
                object.bounds.extend(corner);
            }
        }
        object.digest = digest_object(object, map_);
        map_.objects.push_back(std::move(object));
        return {};
    }

    std::uint32_t flattened_mesh(std::uint32_t mesh, const glm::mat4x3& world_from_object) {
        Mesh flat = map_.meshes[mesh];
        flat.bounds = {};
        for (Primitive& primitive : flat.primitives) {
            for (glm::vec3& position : primitive.positions) {
                position = world_from_object * glm::vec4(position, 1) + 0.0f;
                flat.bounds.extend(position);
            }
            primitive.digest = digest_primitive(primitive, map_);
        }
        flat.digest = digest_mesh(flat);
        const auto [entry, added] =
            shared_.meshes.try_emplace(flat.digest, static_cast<std::uint32_t>(map_.meshes.size()));
        if (added)
            map_.meshes.push_back(std::move(flat));
        return entry->second;
    }

    Imported add_volume(const Pending& pending,
                        std::uint32_t mesh,
                        const glm::dmat4& world_from_object,
                        std::string name) {
        Volume volume;
        volume.kind = pending.role == NodeRole::interior ? VolumeKind::interior : VolumeKind::no_probes;
        volume.probe_name = volume.kind == VolumeKind::interior ? pending.bake_probe : "";
        volume.name = std::move(name);
        for (const Primitive& primitive : map_.meshes[mesh].primitives) {
            const auto first = static_cast<std::uint32_t>(volume.positions.size());
            for (const glm::vec3& position : primitive.positions) {
                volume.positions.emplace_back(glm::dvec3(world_from_object * glm::dvec4(position, 1)) + 0.0);
                if (is_far(volume.positions.back()))
                    return fail_far(pending.node);
            }
            for (const glm::uvec3& triangle : primitive.triangles)
                volume.triangles.push_back(triangle + first);
        }
        volume.digest = digest_volume(volume);
        map_.volumes.push_back(std::move(volume));
        return {};
    }

    Imported add_light(std::size_t index, const glm::dmat4& world_from_node) {
        const auto found = model_.nodes[index].extensions.find("KHR_lights_punctual");
        if (found == model_.nodes[index].extensions.end())
            return {};
        auto light =
            import_light(model_, found->second.Get("light").GetNumberAsInt());  // checked with the document
        if (!light)
            return fail(index, light.error());
        if (is_far(world_from_node[3]))
            return fail_far(index);
        light->position = glm::vec3(world_from_node[3]);
        const glm::dvec3 shines = -glm::dvec3(world_from_node[2]);  // along the node's -z
        light->direction = glm::length(shines) > 0 ? glm::vec3(glm::normalize(shines)) : glm::vec3(0, 0, -1);
        light->name = model_.nodes[index].name;
        map_.lights.push_back(std::move(*light));
        return {};
    }

    const GltfDocument& document_;
    const tinygltf::Model& model_;
    const MaterialIndices& materials_;
    Map& map_;
    Shared& shared_;
    std::vector<std::optional<std::uint32_t>> mesh_of_;  // by glTF mesh, once imported
    std::size_t placed_vertices_ = 0, copied_vertices_ = 0;
};

}  // namespace

Imported import_nodes(const GltfDocument& document,
                      const MaterialIndices& materials,
                      Map& map,
                      Shared& shared) {
    return NodeImporter(document, materials, map, shared).run();
}

}  // namespace drtv::map
