#include "bakerd/map/skin.h"

#include "bakerd/map/accessor.h"
#include "bakerd/map/node_transform.h"

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <utility>

namespace drtv::map {
namespace {

constexpr std::size_t joints_a_set = 4;

// The joints and weights of a primitive's vertices, four in each set.
struct Influences {
    std::size_t sets = 0;
    std::vector<Floats> joints;
    std::vector<Floats> weights;
};

tl::expected<Influences, std::string> read_influences(const GltfDocument& document,
                                                      const NamedPrimitive& primitive,
                                                      std::size_t vertex_count) {
    Influences influences;
    const auto read = [&](const std::string& name) -> tl::expected<Floats, std::string> {
        const auto found = primitive.gltf.attributes.find(name);
        if (found == primitive.gltf.attributes.end())
            return tl::unexpected(
                document.at(fmt::format("{} has no {}, and its node has a skin", primitive.where, name)));
        auto values = read_floats(document, found->second, joints_a_set);
        if (values && values->size() != joints_a_set * vertex_count)
            return tl::unexpected(document.at(fmt::format("{}: {} has {} elements, POSITION has {}",
                                                          primitive.where,
                                                          name,
                                                          values->size() / joints_a_set,
                                                          vertex_count)));
        return values;
    };
    const auto has = [&](const std::string& name) { return primitive.gltf.attributes.contains(name); };
    for (std::size_t set = 0; set == 0 || has(fmt::format("JOINTS_{}", set)); ++set) {
        auto joints = read(fmt::format("JOINTS_{}", set));
        if (!joints)
            return tl::unexpected(joints.error());
        auto weights = read(fmt::format("WEIGHTS_{}", set));
        if (!weights)
            return tl::unexpected(weights.error());
        influences.joints.push_back(std::move(*joints));
        influences.weights.push_back(std::move(*weights));
        ++influences.sets;
    }
    return influences;
}

// The matrices of a vertex's joints, weighted; nothing where it names a joint that is not there.
std::optional<glm::dmat4> blended(const SkinPose& pose, const Influences& influences, std::size_t vertex) {
    glm::dmat4 sum(0);
    double total = 0;
    for (std::size_t set = 0; set < influences.sets; ++set) {
        for (std::size_t k = 0; k < joints_a_set; ++k) {
            const std::size_t at = joints_a_set * vertex + k;
            const double weight = static_cast<double>(influences.weights[set][at]);
            if (weight <= 0)
                continue;
            const auto joint = static_cast<std::size_t>(influences.joints[set][at]);
            if (joint >= pose.scene_from_mesh.size())
                return std::nullopt;
            sum += weight * pose.scene_from_mesh[joint];
            total += weight;
        }
    }
    // A vertex that hangs on nothing goes with the first joint.
    return total > 0 ? sum * (1 / total) : pose.scene_from_mesh[0];
}

glm::dmat4 matrix_at(const Floats& numbers, std::size_t element) {
    glm::dmat4 matrix(1);
    for (glm::length_t c = 0; c < 4; ++c) {
        for (glm::length_t r = 0; r < 4; ++r)
            matrix[c][r] = static_cast<double>(numbers[16 * element + static_cast<std::size_t>(4 * c + r)]);
    }
    return matrix;
}

}  // namespace

tl::expected<const SkinPose*, std::string> Skins::pose_of(int skin) {
    std::optional<SkinPose>& pose = poses_[static_cast<std::size_t>(skin)];
    if (!pose) {
        auto read = read_pose(skin);
        if (!read)
            return tl::unexpected(read.error());
        pose = std::move(*read);
    }
    return &*pose;
}

tl::expected<SkinPose, std::string> Skins::read_pose(int skin) {
    if (scene_from_node_.empty()) {
        if (auto found = find_node_places(); !found)
            return tl::unexpected(found.error());
    }
    const tinygltf::Skin& source = at_index(document_.model.skins, skin);
    Floats inverses;
    if (source.inverseBindMatrices >= 0) {
        constexpr std::size_t numbers_a_matrix = 16;
        auto read = read_floats(document_, source.inverseBindMatrices, numbers_a_matrix);
        if (!read)
            return tl::unexpected(fmt::format("{} (in skin {})", read.error(), skin));
        inverses = std::move(*read);
        if (inverses.size() < numbers_a_matrix * source.joints.size())
            return tl::unexpected(
                document_.at(fmt::format("skin {} has {} joints, and {} inverse bind matrices",
                                         skin,
                                         source.joints.size(),
                                         inverses.size() / numbers_a_matrix)));
    }
    SkinPose pose{skin, {}};
    for (std::size_t n = 0; n < source.joints.size(); ++n) {
        const glm::dmat4& scene_from_joint = at_index(scene_from_node_, source.joints[n]);
        pose.scene_from_mesh.push_back(inverses.empty() ? scene_from_joint
                                                        : scene_from_joint * matrix_at(inverses, n));
    }
    return pose;
}

tl::expected<void, std::string> Skins::find_node_places() {
    const std::vector<tinygltf::Node>& nodes = document_.model.nodes;
    std::vector<int> parents(nodes.size(), -1);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        for (const int child : nodes[n].children)
            parents[static_cast<std::size_t>(child)] = static_cast<int>(n);
    }
    std::vector<int> waiting;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (parents[n] < 0)
            waiting.push_back(static_cast<int>(n));
    }
    scene_from_node_.assign(nodes.size(), glm::dmat4(1));
    while (!waiting.empty()) {
        const int index = waiting.back();
        waiting.pop_back();
        const tinygltf::Node& node = at_index(nodes, index);
        const auto local = local_transform(node);
        if (!local)
            return tl::unexpected(document_.at(fmt::format("node {}: {}", index, local.error())));
        glm::dmat4& place = scene_from_node_[static_cast<std::size_t>(index)];
        const int parent = at_index(parents, index);
        place = parent < 0 ? *local : at_index(scene_from_node_, parent) * *local;
        waiting.insert(waiting.end(), node.children.begin(), node.children.end());
    }
    return {};
}

tl::expected<void, std::string> take_pose(const SkinPose& pose,
                                          const GltfDocument& document,
                                          const NamedPrimitive& primitive,
                                          Floats& positions) {
    const std::size_t vertex_count = positions.size() / 3;
    const auto influences = read_influences(document, primitive, vertex_count);
    if (!influences)
        return tl::unexpected(influences.error());
    for (std::size_t n = 0; n < vertex_count; ++n) {
        const auto scene_from_mesh = blended(pose, *influences, n);
        if (!scene_from_mesh)
            return tl::unexpected(document.at(
                fmt::format("{}: vertex {} hangs on a joint that skin {} does not have, it has {}",
                            primitive.where,
                            n,
                            pose.skin,
                            pose.scene_from_mesh.size())));
        float* p = &positions[3 * n];
        const glm::dvec4 posed = *scene_from_mesh * glm::dvec4(p[0], p[1], p[2], 1);
        for (glm::length_t k = 0; k < 3; ++k)
            p[k] = static_cast<float>(posed[k]);
    }
    return {};
}

}  // namespace drtv::map
