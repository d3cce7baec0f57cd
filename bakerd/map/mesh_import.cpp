#include "bakerd/map/mesh_import.h"

#include "bakerd/map/accessor.h"
#include "bakerd/map/brightness_warning.h"
#include "bakerd/map/content_digest.h"
#include "bakerd/map/mesh_attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace drtv::map {
namespace {

using Triangles = std::vector<glm::uvec3>;

// Primitives may share accessors, so that a small file can ask for much; more than 3 GB of unshared ones is
// no map.
constexpr std::size_t max_mesh_elements = std::size_t{1} << 28;
// Counted for each skin: what is posed is kept anew.
constexpr std::size_t max_posed_elements = std::size_t{1} << 26;

bool is_degenerate(const glm::uvec3& t) {
    return t.x == t.y || t.y == t.z || t.z == t.x;
}

// Strips and fans keep the winding as glTF 2.0 (3.7.2.1) gives it.
Triangles assemble(const Indices& indices, int mode) {
    Triangles triangles;
    if (indices.size() < 3)
        return triangles;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        for (std::size_t n = 0; n + 2 < indices.size(); n += 3)
            triangles.emplace_back(indices[n], indices[n + 1], indices[n + 2]);
    } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        for (std::size_t n = 0; n + 2 < indices.size(); ++n)
            triangles.emplace_back(indices[n], indices[n + 1 + n % 2], indices[n + 2 - n % 2]);
    } else if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
        for (std::size_t n = 1; n + 1 < indices.size(); ++n)
            triangles.emplace_back(indices[n], indices[n + 1], indices[0]);
    }
    std::erase_if(triangles, is_degenerate);
    return triangles;
}

glm::vec2 uv_at(const std::vector<float>& uvs, std::size_t vertex) {
    const float* uv = &uvs[vertex * 2];
    return glm::vec2(uv[0], uv[1]) + 0.0f;
}

glm::vec4 colour_at(const Attributes& attributes, std::size_t vertex) {
    const float* c = &attributes.colours[vertex * attributes.colour_components];
    const float alpha = attributes.colour_components == 4 ? c[3] : 1.0f;
    return glm::clamp(glm::vec4(c[0], c[1], c[2], alpha), 0.0f, 1.0f);
}

void append_vertex(Primitive& primitive, const Attributes& attributes, std::size_t vertex) {
    const float* p = &attributes.positions[vertex * 3];
    primitive.positions.push_back(glm::vec3(p[0], p[1], p[2]) + 0.0f);  // no negative zeros
    if (!attributes.uvs.empty())
        primitive.uvs.push_back(uv_at(attributes.uvs, vertex));
    if (!attributes.emission_uvs.empty())
        primitive.emission_uvs.push_back(uv_at(attributes.emission_uvs, vertex));
    if (!attributes.transmission_uvs.empty())
        primitive.transmission_uvs.push_back(uv_at(attributes.transmission_uvs, vertex));
    if (!attributes.colours.empty())
        primitive.colours.push_back(colour_at(attributes, vertex));
}

// Keeps only the vertices in use, in the order of their first use: the order in the file does not matter.
Primitive compact(const Attributes& attributes, Triangles triangles, std::uint32_t material) {
    Primitive primitive;
    primitive.material = material;
    Indices renumbered(attributes.vertex_count, UINT32_MAX);
    for (glm::uvec3& triangle : triangles) {
        for (glm::length_t k = 0; k < 3; ++k) {
            const std::uint32_t old = triangle[k];
            std::uint32_t& fresh = renumbered[old];
            if (fresh == UINT32_MAX) {
                fresh = static_cast<std::uint32_t>(primitive.positions.size());
                append_vertex(primitive, attributes, old);
            }
            triangle[k] = fresh;
        }
    }
    primitive.triangles = std::move(triangles);
    return primitive;
}

// Those in the file, or one after the other.
tl::expected<Indices, std::string> indices_of(const GltfDocument& document,
                                              const NamedPrimitive& primitive,
                                              std::size_t vertex_count) {
    if (primitive.gltf.indices < 0) {
        Indices indices(vertex_count);
        std::iota(indices.begin(), indices.end(), 0u);
        return indices;
    }
    auto indices = read_indices(document, primitive.gltf.indices);
    if (!indices)
        return indices;
    for (std::uint32_t index : *indices) {
        if (index >= vertex_count)
            return tl::unexpected(document.at(
                fmt::format("{}: index {} is past the {} vertices", primitive.where, index, vertex_count)));
    }
    return indices;
}

tl::expected<Primitive, std::string> import_primitive(const ImportState& state,
                                                      const NamedPrimitive& primitive,
                                                      const SkinPose* pose,
                                                      const MaterialIndices& materials) {
    const tinygltf::Primitive& source = primitive.gltf;
    const GltfDocument& document = state.document;
    const int mode = source.mode < 0 ? TINYGLTF_MODE_TRIANGLES : source.mode;
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN)
        return tl::unexpected(document.at(fmt::format("{}: mode {} is unknown", primitive.where, mode)));
    if (mode < TINYGLTF_MODE_TRIANGLES)
        return Primitive{};  // points and lines block no light
    const std::uint32_t material =
        source.material < 0 ? materials.back() : at_index(materials, source.material);
    if (!source.attributes.contains("POSITION"))
        return Primitive{};  // as the specification says
    auto attributes = read_attributes(document, primitive, state.map.materials[material]);
    if (!attributes)
        return tl::unexpected(attributes.error());
    if (pose != nullptr) {
        if (auto posed = take_pose(*pose, document, primitive, attributes->positions); !posed)
            return tl::unexpected(posed.error());
    }
    const auto indices = indices_of(document, primitive, attributes->vertex_count);
    if (!indices)
        return tl::unexpected(indices.error());
    return compact(*attributes, assemble(*indices, mode), material);
}

std::size_t elements_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
    std::size_t elements = 0;
    if (primitive.indices >= 0)
        elements += at_index(model.accessors, primitive.indices).count;
    for (const auto& [name, accessor] : primitive.attributes)
        elements += at_index(model.accessors, accessor).count;
    return elements;
}

tl::expected<std::uint32_t, std::string> import_mesh(const ImportState& state,
                                                     std::size_t index,
                                                     const SkinPose* pose,
                                                     const MaterialIndices& materials) {
    const tinygltf::Mesh& source = state.document.model.meshes[index];
    Mesh mesh;
    for (std::size_t n = 0; n < source.primitives.size(); ++n) {
        const NamedPrimitive named{source.primitives[n], fmt::format("mesh {}, primitive {}", index, n)};
        auto primitive = import_primitive(state, named, pose, materials);
        if (!primitive)
            return tl::unexpected(primitive.error());
        if (primitive->triangles.empty())
            continue;
        primitive->digest = digest_primitive(*primitive, state.map);
        warn_of_brightness(state, named.gltf.material, *primitive);
        for (const glm::vec3& position : primitive->positions)
            mesh.bounds.extend(position);
        mesh.primitives.push_back(std::move(*primitive));
    }
    if (mesh.primitives.empty())
        return no_mesh;
    std::ranges::stable_sort(mesh.primitives, {}, &Primitive::digest);
    mesh.digest = digest_mesh(mesh);
    return keep_once(std::move(mesh), state.map.meshes, state.shared.meshes);
}

}  // namespace

Imported check_mesh_sizes(const GltfDocument& document) {
    const tinygltf::Model& model = document.model;
    std::size_t elements = 0;
    for (std::size_t n = 0; n < model.meshes.size(); ++n) {
        for (const tinygltf::Primitive& primitive : model.meshes[n].primitives)
            elements += elements_of(model, primitive);
        if (elements > max_mesh_elements)
            return tl::unexpected(document.at(fmt::format(
                "mesh {}: the accessors of all primitives up to it have {} elements, over the limit of {}",
                n,
                elements,
                max_mesh_elements)));
    }
    return {};
}

tl::expected<std::uint32_t, std::string> MeshImporter::index_of(const tinygltf::Node& node) {
    const std::pair key(node.mesh, node.skin);
    if (const auto known = known_.find(key); known != known_.end())
        return known->second;
    const SkinPose* pose = nullptr;
    if (node.skin >= 0) {
        const auto found = skins_.pose_of(node.skin);
        if (!found)
            return tl::unexpected(found.error());
        pose = *found;
    }
    // A mesh of many skins is many meshes.
    const tinygltf::Model& model = state_.document.model;
    if (pose != nullptr) {
        for (const tinygltf::Primitive& primitive : at_index(model.meshes, node.mesh).primitives)
            posed_elements_ += elements_of(model, primitive);
        if (posed_elements_ > max_posed_elements)
            return tl::unexpected(state_.document.at(fmt::format(
                "skin {}: with it the accessors of posed meshes have {} elements, over the limit of {}",
                node.skin,
                posed_elements_,
                max_posed_elements)));
    }
    const auto imported = import_mesh(state_, static_cast<std::size_t>(node.mesh), pose, materials_);
    if (imported)
        known_[key] = *imported;
    return imported;
}

}  // namespace drtv::map
