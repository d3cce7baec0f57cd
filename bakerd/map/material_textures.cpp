#include "bakerd/map/material_textures.h"

namespace drtv::map {
namespace {

const tinygltf::Value* extension_of(const tinygltf::Material& material, const char* name) {
    const auto found = material.extensions.find(name);
    return found == material.extensions.end() ? nullptr : &found->second;
}

template <class TextureInfo>
TextureUse use_of(const TextureInfo& info) {
    return {info.index, info.texCoord, info.extensions};
}

// Inside an extension tinygltf leaves textures as they stand. REQUIRES: they were checked (material_check).
TextureUse use_in(const tinygltf::Value* extension, const char* name) {
    if (extension == nullptr || !extension->Has(name))
        return {};
    const tinygltf::Value& texture = extension->Get(name);
    TextureUse use;
    use.index = texture.Get("index").GetNumberAsInt();
    if (texture.Has("texCoord"))
        use.tex_coord = texture.Get("texCoord").GetNumberAsInt();
    if (texture.Has("extensions")) {
        const tinygltf::Value& extensions = texture.Get("extensions");
        for (const std::string& key : extensions.Keys())
            use.extensions[key] = extensions.Get(key);
    }
    return use;
}

}  // namespace

const tinygltf::Value* specular_glossiness_of(const tinygltf::Material& material) {
    return extension_of(material, "KHR_materials_pbrSpecularGlossiness");
}

const tinygltf::Value* transmission_of(const tinygltf::Material& material) {
    return extension_of(material, "KHR_materials_transmission");
}

TextureUse base_texture_of(const tinygltf::Material& material) {
    const tinygltf::Value* specular_glossiness = specular_glossiness_of(material);
    return specular_glossiness != nullptr ? use_in(specular_glossiness, "diffuseTexture")
                                          : use_of(material.pbrMetallicRoughness.baseColorTexture);
}

TextureUse emission_texture_of(const tinygltf::Material& material) {
    return use_of(material.emissiveTexture);
}

TextureUse transmission_texture_of(const tinygltf::Material& material) {
    return use_in(transmission_of(material), "transmissionTexture");
}

}  // namespace drtv::map
