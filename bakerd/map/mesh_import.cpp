#include "bakerd/map/import_parts.h"

#include "bakerd/map/accessor.h"
#include "bakerd/map/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace drtv::map {
namespace {

using Triangles = std::vector<glm::uvec3>;

// Primitives may share accessors, so that a small file can ask for much; more than 3 GB of unshared ones is
// no map.
constexpr std::size_t max_mesh_elements = std::size_t{1} << 28;

// Strips and fans keep the winding as glTF 2.0 (3.7.2.1) gives it.
Triangles assemble(const std::vector<std::uint32_t>& indices, int mode) {
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
    std::erase_if(triangles, [](const glm::uvec3& t) { return t.x == t.y || t.y == t.z || t.z == t.x; });
    return triangles;
}

struct Attributes {
    std::vector<float> positions, uvs, emission_uvs, colours;
    std::size_t vertex_count = 0, colour_components = 0;
};

tl::expected<std::vector<float>, std::string> read_attribute(const GltfDocument& document,
                                                             const tinygltf::Primitive& source,
                                                             const std::string& name,
                                                             std::size_t components,
                                                             const std::string& where,
                                                             std::size_t vertex_count) {
    const auto found = source.attributes.find(name);
    if (found == source.attributes.end())
        return std::vector<float>{};
    const auto& accessor = document.model.accessors[static_cast<std::size_t>(found->second)];
    if (vertex_count != 0 && accessor.count != vertex_count) {
        return tl::unexpected(document.at(fmt::format(
            "{}: {} has {} elements, POSITION has {}", where, name, accessor.count, vertex_count)));
    }
    auto values = read_floats(document, found->second, components);
    if (!values)
        return tl::unexpected(fmt::format("{} (in {}, {})", values.error(), where, name));
    return values;
}

tl::expected<Attributes, std::string> read_attributes(const GltfDocument& document,
                                                      const tinygltf::Primitive& source,
                                                      const Material& material,
                                                      const std::string& where) {
    Attributes attributes;
    auto positions = read_attribute(document, source, "POSITION", 3, where, 0);
    if (!positions)
        return tl::unexpected(positions.error());
    attributes.positions = std::move(*positions);
    attributes.vertex_count = attributes.positions.size() / 3;
    if (attributes.vertex_count == 0)
        return attributes;

    const auto read_uvs = [&](const auto& texture) -> tl::expected<std::vector<float>, std::string> {
        int set = texture.texCoord;
        const auto transform = texture.extensions.find("KHR_texture_transform");
        if (transform != texture.extensions.end() && transform->second.Has("texCoord") &&
            transform->second.Get("texCoord").IsNumber())
            set = transform->second.Get("texCoord").GetNumberAsInt();
        auto uvs = read_attribute(
            document, source, fmt::format("TEXCOORD_{}", set), 2, where, attributes.vertex_count);
        // Without coordinates a texture shows its first texel everywhere, as renderers do.
        if (uvs && uvs->empty())
            uvs->assign(attributes.vertex_count * 2, 0.0f);
        return uvs;
    };
    if (material.base_texture.present()) {
        auto uvs = read_uvs(document.model.materials[static_cast<std::size_t>(source.material)]
                                .pbrMetallicRoughness.baseColorTexture);
        if (!uvs)
            return tl::unexpected(uvs.error());
        attributes.uvs = std::move(*uvs);
    }
    if (material.emission_texture.present()) {
        auto uvs =
            read_uvs(document.model.materials[static_cast<std::size_t>(source.material)].emissiveTexture);
        if (!uvs)
            return tl::unexpected(uvs.error());
        attributes.emission_uvs = std::move(*uvs);
    }
    const auto colour = source.attributes.find("COLOR_0");
    if (colour != source.attributes.end()) {
        attributes.colour_components = component_count(document, colour->second);
        if (attributes.colour_components != 3)
            attributes.colour_components = 4;
        auto colours = read_attribute(
            document, source, "COLOR_0", attributes.colour_components, where, attributes.vertex_count);
        if (!colours)
            return tl::unexpected(colours.error());
        attributes.colours = std::move(*colours);
    }
    return attributes;
}

// Keeps only the vertices in use, in the order of their first use: the order in the file does not matter.
Primitive compact(const Attributes& attributes, Triangles triangles, std::uint32_t material) {
    Primitive primitive;
    primitive.material = material;
    std::vector<std::uint32_t> renumbered(attributes.vertex_count, UINT32_MAX);
    for (glm::uvec3& triangle : triangles) {
        for (glm::length_t k = 0; k < 3; ++k) {
            const std::uint32_t old = triangle[k];
            std::uint32_t& fresh = renumbered[old];
            if (fresh == UINT32_MAX) {
                fresh = static_cast<std::uint32_t>(primitive.positions.size());
                const float* p = &attributes.positions[std::size_t{old} * 3];
                primitive.positions.push_back(glm::vec3(p[0], p[1], p[2]) + 0.0f);  // no negative zeros
                const auto uv_of = [old](const std::vector<float>& uvs) {
                    return glm::vec2(uvs[std::size_t{old} * 2], uvs[std::size_t{old} * 2 + 1]) + 0.0f;
                };
                if (!attributes.uvs.empty())
                    primitive.uvs.push_back(uv_of(attributes.uvs));
                if (!attributes.emission_uvs.empty())
                    primitive.emission_uvs.push_back(uv_of(attributes.emission_uvs));
                if (!attributes.colours.empty()) {
                    const float* c = &attributes.colours[std::size_t{old} * attributes.colour_components];
                    primitive.colours.emplace_back(glm::clamp(
                        glm::vec4(c[0], c[1], c[2], attributes.colour_components == 4 ? c[3] : 1.0f),
                        0.0f,
                        1.0f));
                }
            }
            triangle[k] = fresh;
        }
    }
    primitive.triangles = std::move(triangles);
    return primitive;
}

tl::expected<Primitive, std::string> import_primitive(const GltfDocument& document,
                                                      const tinygltf::Primitive& source,
                                                      const std::string& where,
                                                      const MaterialIndices& materials,
                                                      const Map& map) {
    const int mode = source.mode < 0 ? TINYGLTF_MODE_TRIANGLES : source.mode;
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN)
        return tl::unexpected(document.at(fmt::format("{}: mode {} is unknown", where, mode)));
    if (mode < TINYGLTF_MODE_TRIANGLES)
        return Primitive{};  // points and lines block no light
    const std::uint32_t material =
        source.material < 0 ? materials.back() : materials[static_cast<std::size_t>(source.material)];
    if (!source.attributes.contains("POSITION"))
        return Primitive{};  // as the specification says
    const auto attributes = read_attributes(document, source, map.materials[material], where);
    if (!attributes)
        return tl::unexpected(attributes.error());

    std::vector<std::uint32_t> indices;
    if (source.indices >= 0) {
        auto read = read_indices(document, source.indices);
        if (!read)
            return tl::unexpected(read.error());
        indices = std::move(*read);
        for (std::uint32_t index : indices) {
            if (index >= attributes->vertex_count)
                return tl::unexpected(document.at(fmt::format(
                    "{}: index {} is past the {} vertices", where, index, attributes->vertex_count)));
        }
    } else {
        indices.resize(attributes->vertex_count);
        for (std::size_t n = 0; n < indices.size(); ++n)
            indices[n] = static_cast<std::uint32_t>(n);
    }
    return compact(*attributes, assemble(indices, mode), material);
}

// A surface that sends back more than max_albedo is more likely a mistake than snow, and light in a room of
// it would hardly ever end.
void warn_of_brightness(
    const GltfDocument& document, int gltf_material, const Primitive& primitive, Map& map, Shared& shared) {
    const Material& material = map.materials[primitive.material];
    glm::vec3 albedo(material.base_colour);
    const auto too_bright = [&] { return std::max({albedo.x, albedo.y, albedo.z}) > max_albedo; };
    if (gltf_material < 0 || !too_bright())
        return;  // glTF's default material is white, and nobody's choice
    if (!primitive.colours.empty()) {
        glm::vec3 most(0);
        for (const glm::vec4& colour : primitive.colours)
            most = glm::max(most, glm::vec3(colour));
        albedo *= most;
    }
    if (material.base_texture.present()) {
        const auto [entry, added] = shared.brightest.try_emplace(material.base_texture.texture);
        if (added)
            entry->second = brightest(map.textures[material.base_texture.texture]);
        albedo *= entry->second;
    }
    if (!too_bright())
        return;
    const std::string where =
        document.at(name_of_material(document, static_cast<std::size_t>(gltf_material)));
    if (!shared.warned_of_brightness.insert(where).second)
        return;
    warn(map,
         fmt::format("{}: its albedo reaches {:.3g}, and counts as {}",
                     where,
                     std::max({albedo.x, albedo.y, albedo.z}),
                     max_albedo));
}

}  // namespace

Imported check_mesh_sizes(const GltfDocument& document) {
    const tinygltf::Model& model = document.model;
    std::size_t elements = 0;
    for (std::size_t n = 0; n < model.meshes.size(); ++n) {
        for (const tinygltf::Primitive& primitive : model.meshes[n].primitives) {
            if (primitive.indices >= 0)
                elements += model.accessors[static_cast<std::size_t>(primitive.indices)].count;
            for (const auto& [name, accessor] : primitive.attributes)
                elements += model.accessors[static_cast<std::size_t>(accessor)].count;
        }
        if (elements > max_mesh_elements)
            return tl::unexpected(document.at(fmt::format(
                "mesh {}: the accessors of all primitives up to it have {} elements, over the limit of {}",
                n,
                elements,
                max_mesh_elements)));
    }
    return {};
}

tl::expected<std::uint32_t, std::string> import_mesh(const GltfDocument& document,
                                                     std::size_t index,
                                                     const MaterialIndices& materials,
                                                     Map& map,
                                                     Shared& shared) {
    const tinygltf::Mesh& source = document.model.meshes[index];
    Mesh mesh;
    for (std::size_t n = 0; n < source.primitives.size(); ++n) {
        auto primitive = import_primitive(
            document, source.primitives[n], fmt::format("mesh {}, primitive {}", index, n), materials, map);
        if (!primitive)
            return tl::unexpected(primitive.error());
        if (primitive->triangles.empty())
            continue;
        primitive->digest = digest_primitive(*primitive, map);
        warn_of_brightness(document, source.primitives[n].material, *primitive, map, shared);
        for (const glm::vec3& position : primitive->positions)
            mesh.bounds.extend(position);
        mesh.primitives.push_back(std::move(*primitive));
    }
    if (mesh.primitives.empty())
        return no_mesh;
    std::stable_sort(mesh.primitives.begin(),
                     mesh.primitives.end(),
                     [](const Primitive& a, const Primitive& b) { return a.digest < b.digest; });
    mesh.digest = digest_mesh(mesh);
    const auto [entry, added] =
        shared.meshes.try_emplace(mesh.digest, static_cast<std::uint32_t>(map.meshes.size()));
    if (added)
        map.meshes.push_back(std::move(mesh));
    return entry->second;
}

}  // namespace drtv::map
