#include "bakerd/map/import_parts.h"

#include "bakerd/map/texture.h"

#include <fmt/format.h>

#include <cmath>

namespace drtv::map {
namespace {

Wrap wrap_of(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp;
    if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::mirror;
    return Wrap::repeat;
}

// KHR_texture_transform: offset, rotation, scale, in that order around the texture's origin.
tl::expected<void, std::string> apply_texture_transform(const tinygltf::Value& extension, Material& material) {
    double offset[2] = {0, 0}, scale[2] = {1, 1}, rotation = 0;
    const auto read_pair = [&](const char* name, double (&pair)[2]) {
        if (!extension.Has(name)) return true;
        const tinygltf::Value& value = extension.Get(name);
        if (!value.IsArray() || value.ArrayLen() != 2) return false;
        for (int k = 0; k < 2; ++k) {
            if (!value.Get(k).IsNumber()) return false;
            pair[k] = value.Get(k).GetNumberAsDouble();
        }
        return std::isfinite(pair[0]) && std::isfinite(pair[1]);
    };
    if (!read_pair("offset", offset)) return tl::unexpected(std::string("KHR_texture_transform: offset must be two numbers"));
    if (!read_pair("scale", scale)) return tl::unexpected(std::string("KHR_texture_transform: scale must be two numbers"));
    if (extension.Has("rotation")) {
        if (!extension.Get("rotation").IsNumber()) return tl::unexpected(std::string("KHR_texture_transform: rotation must be a number"));
        rotation = extension.Get("rotation").GetNumberAsDouble();
    }
    const double c = std::cos(rotation), s = std::sin(rotation);
    material.texture_u_from_uv = glm::vec3(glm::dvec3(c * scale[0], s * scale[1], offset[0]));
    material.texture_v_from_uv = glm::vec3(glm::dvec3(-s * scale[0], c * scale[1], offset[1]));
    return {};
}

tl::expected<std::uint32_t, std::string> import_texture(const GltfDocument& document, int texture_index, const std::string& where, Map& map, Shared& shared) {
    const tinygltf::Model& model = document.model;
    const auto fail = [&](const std::string& rest) { return tl::unexpected(document.at(where + ": " + rest)); };
    const tinygltf::Texture& source = model.textures[static_cast<std::size_t>(texture_index)];
    if (source.source < 0) return fail(fmt::format("texture {} has no PNG or JPEG source", texture_index));
    const tinygltf::Image& image = model.images[static_cast<std::size_t>(source.source)];
    const std::string image_name = image.uri.empty() ? fmt::format("image {}", source.source) : fmt::format("image {} ('{}')", source.source, image.uri);
    if (image.image.empty()) return fail(fmt::format("{} has no bytes; is the file missing?", image_name));
    auto texture = decode_texture(image.image);
    if (!texture) return fail(fmt::format("{}: {}", image_name, texture.error()));
    if (source.sampler >= 0) {
        const tinygltf::Sampler& sampler = model.samplers[static_cast<std::size_t>(source.sampler)];
        texture->wrap_u = wrap_of(sampler.wrapS);
        texture->wrap_v = wrap_of(sampler.wrapT);
    }
    texture->digest = digest_texture(*texture);
    const auto [entry, added] = shared.textures.try_emplace(texture->digest, static_cast<std::uint32_t>(map.textures.size()));
    if (added) map.textures.push_back(std::move(*texture));
    return entry->second;
}

std::uint32_t keep(Material material, Map& map, Shared& shared) {
    material.digest = digest_material(material, map);
    const auto [entry, added] = shared.materials.try_emplace(material.digest, static_cast<std::uint32_t>(map.materials.size()));
    if (added) map.materials.push_back(material);
    return entry->second;
}

}  // namespace

tl::expected<MaterialIndices, std::string> import_materials(const GltfDocument& document, Map& map, Shared& shared) {
    MaterialIndices indices;
    for (std::size_t n = 0; n < document.model.materials.size(); ++n) {
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
            const auto texture = import_texture(document, pbr.baseColorTexture.index, where, map, shared);
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
