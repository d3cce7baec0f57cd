#include "bakerd/map/import_parts.h"

#include "bakerd/map/texture.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <tuple>

namespace drtv::map {
namespace {

Wrap wrap_of(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp;
    if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::mirror;
    return Wrap::repeat;
}

// Far beyond any picture; further out, coordinates would overflow.
constexpr float max_transform = 1e6f;

// KHR_texture_transform: offset, rotation, scale, in that order around the texture's origin. The document's check
// saw to the types.
tl::expected<void, std::string> apply_texture_transform(const tinygltf::Value& extension, Material& material) {
    glm::dvec2 offset(0), scale(1);
    const auto read_pair = [&](const char* name, glm::dvec2& pair) {
        if (extension.Has(name)) pair = {extension.Get(name).Get(0).GetNumberAsDouble(), extension.Get(name).Get(1).GetNumberAsDouble()};
    };
    read_pair("offset", offset);
    read_pair("scale", scale);
    const double rotation = extension.Has("rotation") ? extension.Get("rotation").GetNumberAsDouble() : 0;
    const double c = std::cos(rotation), s = std::sin(rotation);
    material.texture_u_from_uv = glm::vec3(glm::dvec3(c * scale.x, s * scale.y, offset.x));
    material.texture_v_from_uv = glm::vec3(glm::dvec3(-s * scale.x, c * scale.y, offset.y));
    for (const glm::vec3& row : {material.texture_u_from_uv, material.texture_v_from_uv}) {
        for (glm::length_t k = 0; k < 3; ++k) {
            if (!(std::abs(row[k]) <= max_transform)) return tl::unexpected(fmt::format("KHR_texture_transform: {} is over the limit of {}", row[k], max_transform));
        }
    }
    return {};
}

// Index into Map::textures of an image with a wrapping, once decoded: many materials may share a picture.
using Decoded = std::map<std::tuple<int, Wrap, Wrap>, std::uint32_t>;

tl::expected<std::uint32_t, std::string> import_texture(const GltfDocument& document, int texture_index, const std::string& where, Map& map, Shared& shared, Decoded& decoded) {
    const tinygltf::Model& model = document.model;
    const auto fail = [&](const std::string& rest) { return tl::unexpected(document.at(where + ": " + rest)); };
    const tinygltf::Texture& source = model.textures[static_cast<std::size_t>(texture_index)];
    if (source.source < 0) return fail(fmt::format("texture {} has no PNG or JPEG source", texture_index));
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    if (source.sampler >= 0) {
        const tinygltf::Sampler& sampler = model.samplers[static_cast<std::size_t>(source.sampler)];
        wrap_u = wrap_of(sampler.wrapS);
        wrap_v = wrap_of(sampler.wrapT);
    }
    const auto known = decoded.find({source.source, wrap_u, wrap_v});
    if (known != decoded.end()) return known->second;

    const tinygltf::Image& image = model.images[static_cast<std::size_t>(source.source)];
    const std::string image_name = image.name.empty() ? fmt::format("image {}", source.source) : fmt::format("image {} ('{}')", source.source, image.name);
    if (image.image.empty()) return fail(fmt::format("{} has no bytes; is the file missing?", image_name));
    auto texture = decode_texture(image.image);
    if (!texture) return fail(fmt::format("{}: {}", image_name, texture.error()));
    texture->wrap_u = wrap_u;
    texture->wrap_v = wrap_v;
    texture->digest = digest_texture(*texture);
    const auto [entry, added] = shared.textures.try_emplace(texture->digest, static_cast<std::uint32_t>(map.textures.size()));
    if (added) map.textures.push_back(std::move(*texture));
    decoded.emplace(std::tuple(source.source, wrap_u, wrap_v), entry->second);
    return entry->second;
}

std::uint32_t keep(Material material, Map& map, Shared& shared) {
    material.digest = digest_material(material, map);
    const auto [entry, added] = shared.materials.try_emplace(material.digest, static_cast<std::uint32_t>(map.materials.size()));
    if (added) map.materials.push_back(material);
    return entry->second;
}

// Whether some primitive wears each material; a picture missing from one that none wears is no harm.
std::vector<bool> worn_materials(const tinygltf::Model& model) {
    std::vector<bool> worn(model.materials.size(), false);
    for (const tinygltf::Mesh& mesh : model.meshes) {
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            if (primitive.material >= 0) worn[static_cast<std::size_t>(primitive.material)] = true;
        }
    }
    return worn;
}

}  // namespace

tl::expected<MaterialIndices, std::string> import_materials(const GltfDocument& document, Map& map, Shared& shared) {
    MaterialIndices indices;
    Decoded decoded;
    const std::vector<bool> worn = worn_materials(document.model);
    for (std::size_t n = 0; n < document.model.materials.size(); ++n) {
        if (!worn[n]) {
            indices.push_back(UINT32_MAX);
            continue;
        }
        const tinygltf::Material& source = document.model.materials[n];
        const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
        const std::string where = source.name.empty() ? fmt::format("material {}", n) : fmt::format("material {} ('{}')", n, source.name);
        Material material;
        for (std::size_t k = 0; k < 4 && k < pbr.baseColorFactor.size(); ++k) {
            const double factor = pbr.baseColorFactor[k];
            if (!(factor >= 0 && factor <= 1)) return tl::unexpected(document.at(fmt::format("{}: baseColorFactor {} lies outside [0, 1]", where, factor)));
            material.base_colour[static_cast<glm::length_t>(k)] = static_cast<float>(factor);
        }
        if (source.alphaMode == "MASK") {
            material.masked = true;
            material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
        } else if (source.alphaMode == "BLEND") {
            // A blended surface is there or not at each point: the more opaque half of it is.
            material.masked = true;
            material.alpha_cutoff = 0.5f;
        } else if (!source.alphaMode.empty() && source.alphaMode != "OPAQUE") {
            return tl::unexpected(document.at(fmt::format("{}: alphaMode '{}' is unknown", where, source.alphaMode)));
        }
        material.double_sided = source.doubleSided;
        if (pbr.baseColorTexture.index >= 0) {
            const auto texture = import_texture(document, pbr.baseColorTexture.index, where, map, shared, decoded);
            if (!texture) return tl::unexpected(texture.error());
            material.texture = *texture;
            const auto transform = pbr.baseColorTexture.extensions.find("KHR_texture_transform");
            if (transform != pbr.baseColorTexture.extensions.end()) {
                if (auto applied = apply_texture_transform(transform->second, material); !applied) return tl::unexpected(document.at(where + ": " + applied.error()));
            }
        }
        indices.push_back(keep(material, map, shared));
    }
    indices.push_back(keep(Material{}, map, shared));
    return indices;
}

}  // namespace drtv::map
