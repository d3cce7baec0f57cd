// The pictures that a glTF material wears, whichever of its members or extensions names them.
#pragma once

#include <tiny_gltf.h>

namespace drtv::map {

// A texture and how it is laid on; what tinygltf's own types for it have in common.
struct TextureUse {
    int index = -1;  // none
    int tex_coord = 0;
    tinygltf::ExtensionMap extensions;
};

// KHR_materials_pbrSpecularGlossiness, where a material has it, replaces colour and picture of the core; or
// nullptr.
[[nodiscard]] const tinygltf::Value* specular_glossiness_of(const tinygltf::Material& material);
// KHR_materials_transmission, or nullptr.
[[nodiscard]] const tinygltf::Value* transmission_of(const tinygltf::Material& material);

[[nodiscard]] TextureUse base_texture_of(const tinygltf::Material& material);
[[nodiscard]] TextureUse emission_texture_of(const tinygltf::Material& material);
[[nodiscard]] TextureUse transmission_texture_of(const tinygltf::Material& material);

}  // namespace drtv::map
