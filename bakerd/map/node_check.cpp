#include "bakerd/map/node_check.h"

#include "bakerd/map/extension_check.h"

namespace drtv::map {
namespace {

Failure check_spot(const Checker& check, Json& light, const std::string& where) {
    if (Failure failure = check.properties(light, where, {required(object_at("spot"))}))
        return failure;
    return check.properties(
        light["spot"], where + " spot", {number_at("innerConeAngle"), number_at("outerConeAngle")});
}

Failure check_light(const Checker& check, Json& light, const std::string& where) {
    const std::initializer_list<Property> members = {
        required(string_at("type")), numbers_at("color", 3), number_at("intensity"), number_at("range")};
    if (Failure failure = check.properties(light, where, members))
        return failure;
    return light["type"] == "spot" ? check_spot(check, light, where) : std::nullopt;
}

Failure check_lights(const Checker& check, Json& root, std::size_t& light_count) {
    Json* extension = extension_of(root, "KHR_lights_punctual");
    if (extension == nullptr)
        return {};
    if (!extension->is_object() || !extension->contains("lights") || !(*extension)["lights"].is_array())
        return "KHR_lights_punctual: lights must be an array";
    for (Json& light : (*extension)["lights"]) {
        const std::string where = fmt::format("light {}", light_count++);
        if (Failure failure = check_light(check, light, where))
            return failure;
    }
    return {};
}

Failure check_node_extensions(const Checker& check,
                              std::size_t light_count,
                              Json& node,
                              const std::string& where) {
    if (Json* light = extension_of(node, "KHR_lights_punctual")) {
        const std::string inner = where + ": KHR_lights_punctual";
        if (Failure failure = check.properties(*light, inner, {required(index_at("light"))}))
            return failure;
        const Json& index = (*light)["light"];
        if (index.get<std::size_t>() >= light_count)
            return fmt::format("{} names light {}, the file has {}", inner, shown(index), light_count);
    }
    if (Json* visibility = extension_of(node, "KHR_node_visibility")) {
        const std::string inner = where + ": KHR_node_visibility";
        if (Failure failure = check.properties(*visibility, inner, {boolean_at("visible")}))
            return failure;
    }
    if (Json* levels = extension_of(node, "MSFT_lod")) {
        const std::string inner = where + ": MSFT_lod";
        if (Failure failure = check.properties(*levels, inner, {required(references_at("ids", "nodes"))}))
            return failure;
    }
    if (Json* instancing = extension_of(node, "EXT_mesh_gpu_instancing")) {
        const std::string inner = where + ": EXT_mesh_gpu_instancing";
        if (Failure failure = check.properties(*instancing, inner, {required(object_at("attributes"))}))
            return failure;
        return check.accessors_of((*instancing)["attributes"], inner);
    }
    return {};
}

Failure check_node(const Checker& check, std::size_t light_count, Json& node, const std::string& where) {
    const std::initializer_list<Property> members = {references_at("children", "nodes"),
                                                     reference_at("mesh", "meshes"),
                                                     numbers_at("matrix", 16),
                                                     numbers_at("translation", 3),
                                                     numbers_at("rotation", 4),
                                                     numbers_at("scale", 3),
                                                     string_at("name"),
                                                     object_at("extensions")};
    if (Failure failure = check.properties(node, where, members))
        return failure;
    const bool has_parts =
        node.contains("translation") || node.contains("rotation") || node.contains("scale");
    if (node.contains("matrix") && has_parts)
        return fmt::format("{} has both a matrix and a translation, rotation or scale", where);
    return check_node_extensions(check, light_count, node, where);
}

Failure check_scene(const Checker& check, Json& scene, const std::string& where) {
    return check.properties(scene, where, {references_at("nodes", "nodes"), string_at("name")});
}

}  // namespace

Failure check_nodes(const Checker& check, Json& root) {
    std::size_t light_count = 0;
    if (Failure failure = check_lights(check, root, light_count))
        return failure;
    const auto check_one_node = [&](Json& node, const std::string& where) {
        return check_node(check, light_count, node, where);
    };
    if (Failure failure = check.each("nodes", "node", check_one_node))
        return failure;
    return check.each("scenes", "scene", [&](Json& scene, const std::string& where) {
        return check_scene(check, scene, where);
    });
}

}  // namespace drtv::map
