#include "bakerd/map/extension_check.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

namespace drtv::map {
namespace {

// What the importer understands.
constexpr std::array<std::string_view, 12> honoured = {"EXT_mesh_gpu_instancing",
                                                       "KHR_lights_punctual",
                                                       "KHR_materials_diffuse_transmission",
                                                       "KHR_materials_emissive_strength",
                                                       "KHR_materials_pbrSpecularGlossiness",
                                                       "KHR_materials_transmission",
                                                       "KHR_materials_unlit",
                                                       "KHR_materials_variants",
                                                       "KHR_mesh_quantization",
                                                       "KHR_node_visibility",
                                                       "KHR_texture_transform",
                                                       "MSFT_lod"};

// Gloss, and what has nothing to do with light: a bake is the same without.
constexpr std::array<std::string_view, 25> harmless = {"ADOBE_materials_clearcoat_specular",
                                                       "ADOBE_materials_clearcoat_tint",
                                                       "AGI_articulations",
                                                       "AGI_stk_metadata",
                                                       "CESIUM_primitive_outline",
                                                       "EXT_instance_features",
                                                       "EXT_mesh_features",
                                                       "EXT_structural_metadata",
                                                       "FB_geometry_metadata",
                                                       "KHR_animation_pointer",
                                                       "KHR_audio_emitter",
                                                       "KHR_implicit_shapes",
                                                       "KHR_interactivity",
                                                       "KHR_materials_anisotropy",
                                                       "KHR_materials_clearcoat",
                                                       "KHR_materials_dispersion",
                                                       "KHR_materials_ior",
                                                       "KHR_materials_iridescence",
                                                       "KHR_materials_sheen",
                                                       "KHR_materials_specular",
                                                       "KHR_node_hoverability",
                                                       "KHR_node_selectability",
                                                       "KHR_physics_rigid_bodies",
                                                       "KHR_xmp",
                                                       "KHR_xmp_json_ld"};

// A file that does not require one of these holds the same without it.
constexpr std::array<std::string_view, 7> with_a_fallback = {"EXT_meshopt_compression",
                                                             "EXT_texture_avif",
                                                             "EXT_texture_webp",
                                                             "KHR_draco_mesh_compression",
                                                             "KHR_meshopt_compression",
                                                             "KHR_texture_basisu",
                                                             "MSFT_texture_dds"};

bool is_one_of(std::span<const std::string_view> names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

bool is_supported(std::string_view extension) {
    return is_one_of(honoured, extension) || is_one_of(harmless, extension);
}

}  // namespace

CheckResult check_extensions(const Json& root) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        const auto found = root.find(list);
        if (found == root.end())
            continue;
        if (!found->is_array())
            return wrong("{} must be an array", list);
        const bool required = std::string_view(list) == "extensionsRequired";
        for (const Json& name : *found) {
            if (!name.is_string())
                return wrong("{} must hold strings, it holds {}", list, shown(name));
            const std::string extension = name.get<std::string>();
            if (required && !is_supported(extension))
                return wrong("it requires the extension {}, which is not supported", extension);
        }
    }
    return {};
}

bool is_passed_over(std::string_view extension) {
    return !is_supported(extension) && !is_one_of(with_a_fallback, extension);
}

Json* extension_of(Json& element, const char* name) {
    const auto extensions = element.find("extensions");
    if (extensions == element.end())
        return nullptr;
    const auto found = extensions->find(name);
    return found == extensions->end() ? nullptr : &*found;
}

}  // namespace drtv::map
