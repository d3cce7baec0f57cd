#include "bakerd/map/node_check.h"

#include "bakerd/map/extension_check.h"

namespace drtv::map {
namespace {

CheckResult check_spot(const Checker& check, Json& light, const std::string& where) {
    if (CheckResult checked = check.properties(light, where, {required(object_at("spot"))}); !checked)
        return checked;
    return check.properties(
        light["spot"], where + " spot", {number_at("innerConeAngle"), number_at("outerConeAngle")});
}

CheckResult check_light(const Checker& check, Json& light, const std::string& where) {
    const std::initializer_list<Property> members = {
        required(string_at("type")), numbers_at("color", 3), number_at("intensity"), number_at("range")};
    if (CheckResult checked = check.properties(light, where, members); !checked)
        return checked;
    return light["type"] == "spot" ? check_spot(check, light, where) : CheckResult();
}

CheckResult check_lights(const Checker& check, Json& root, std::size_t& light_count) {
    Json* extension = extension_of(root, "KHR_lights_punctual");
    if (extension == nullptr)
        return {};
    if (!extension->is_object() || !extension->contains("lights") || !(*extension)["lights"].is_array())
        return wrong("KHR_lights_punctual: lights must be an array");
    for (Json& light : (*extension)["lights"]) {
        const std::string where = fmt::format("light {}", light_count++);
        if (CheckResult checked = check_light(check, light, where); !checked)
            return checked;
    }
    return {};
}

CheckResult check_node_extensions(const Checker& check,
                                  std::size_t light_count,
                                  Json& node,
                                  const std::string& where) {
    if (Json* light = extension_of(node, "KHR_lights_punctual")) {
        const std::string inner = where + ": KHR_lights_punctual";
        if (CheckResult checked = check.properties(*light, inner, {required(index_at("light"))}); !checked)
            return checked;
        const Json& index = (*light)["light"];
        if (index.get<std::size_t>() >= light_count)
            return wrong("{} names light {}, the file has {}", inner, shown(index), light_count);
    }
    if (Json* visibility = extension_of(node, "KHR_node_visibility")) {
        const std::string inner = where + ": KHR_node_visibility";
        if (CheckResult checked = check.properties(*visibility, inner, {boolean_at("visible")}); !checked)
            return checked;
    }
    if (Json* levels = extension_of(node, "MSFT_lod")) {
        const std::string inner = where + ": MSFT_lod";
        if (CheckResult checked = check.properties(*levels, inner, {required(references_at("ids", "nodes"))});
            !checked)
            return checked;
    }
    if (Json* instancing = extension_of(node, "EXT_mesh_gpu_instancing")) {
        const std::string inner = where + ": EXT_mesh_gpu_instancing";
        if (CheckResult checked = check.properties(*instancing, inner, {required(object_at("attributes"))});
            !checked)
            return checked;
        return check.accessors_of((*instancing)["attributes"], inner);
    }
    return {};
}

CheckResult check_node(const Checker& check, std::size_t light_count, Json& node, const std::string& where) {
    const std::initializer_list<Property> members = {references_at("children", "nodes"),
                                                     reference_at("mesh", "meshes"),
                                                     reference_at("skin", "skins"),
                                                     numbers_at("matrix", 16),
                                                     numbers_at("translation", 3),
                                                     numbers_at("rotation", 4),
                                                     numbers_at("scale", 3),
                                                     string_at("name"),
                                                     object_at("extensions")};
    if (CheckResult checked = check.properties(node, where, members); !checked)
        return checked;
    const bool has_parts =
        node.contains("translation") || node.contains("rotation") || node.contains("scale");
    if (node.contains("matrix") && has_parts)
        return wrong("{} has both a matrix and a translation, rotation or scale", where);
    return check_node_extensions(check, light_count, node, where);
}

CheckResult check_skin(const Checker& check, Json& skin, const std::string& where) {
    const std::initializer_list<Property> members = {required(references_at("joints", "nodes")),
                                                     reference_at("inverseBindMatrices", "accessors")};
    if (CheckResult checked = check.properties(skin, where, members); !checked)
        return checked;
    return skin["joints"].empty() ? wrong("{} has no joints", where) : CheckResult();
}

CheckResult check_scene(const Checker& check, Json& scene, const std::string& where) {
    return check.properties(scene, where, {references_at("nodes", "nodes"), string_at("name")});
}

}  // namespace

CheckResult check_nodes(const Checker& check, Json& root) {
    std::size_t light_count = 0;
    if (CheckResult checked = check_lights(check, root, light_count); !checked)
        return checked;
    const auto check_one_node = [&](Json& node, const std::string& where) {
        return check_node(check, light_count, node, where);
    };
    if (CheckResult checked = check.each("nodes", "node", check_one_node); !checked)
        return checked;
    const auto check_one_skin = [&](Json& skin, const std::string& where) {
        return check_skin(check, skin, where);
    };
    if (CheckResult checked = check.each("skins", "skin", check_one_skin); !checked)
        return checked;
    return check.each("scenes", "scene", [&](Json& scene, const std::string& where) {
        return check_scene(check, scene, where);
    });
}

}  // namespace drtv::map
