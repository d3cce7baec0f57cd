#include "bakerd/map/extension_check.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace drtv::map {
namespace {

constexpr std::array supported_extensions = {"EXT_mesh_gpu_instancing",
                                             "KHR_lights_punctual",
                                             "KHR_materials_anisotropy",
                                             "KHR_materials_clearcoat",
                                             "KHR_materials_diffuse_transmission",
                                             "KHR_materials_dispersion",
                                             "KHR_materials_emissive_strength",
                                             "KHR_materials_ior",
                                             "KHR_materials_iridescence",
                                             "KHR_materials_sheen",
                                             "KHR_materials_specular",
                                             "KHR_materials_unlit",
                                             "KHR_materials_variants",
                                             "KHR_mesh_quantization",
                                             "KHR_texture_transform",
                                             "KHR_animation_pointer",
                                             "KHR_xmp_json_ld"};

bool is_supported(const std::string& extension) {
    return std::ranges::find(supported_extensions, extension) != supported_extensions.end();
}

}  // namespace

Failure check_extensions(const Json& root) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        const auto found = root.find(list);
        if (found == root.end())
            continue;
        if (!found->is_array())
            return fmt::format("{} must be an array", list);
        const bool required = std::string_view(list) == "extensionsRequired";
        for (const Json& name : *found) {
            if (!name.is_string())
                return fmt::format("{} must hold strings, it holds {}", list, shown(name));
            const std::string extension = name.get<std::string>();
            if (required && !is_supported(extension))
                return fmt::format("it requires the extension {}, which is not supported", extension);
        }
    }
    return {};
}

Json* extension_of(Json& element, const char* name) {
    const auto extensions = element.find("extensions");
    if (extensions == element.end())
        return nullptr;
    const auto found = extensions->find(name);
    return found == extensions->end() ? nullptr : &*found;
}

}  // namespace drtv::map
