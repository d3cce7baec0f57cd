// Longer than most: one function for each kind of element.
#include "bakerd/map/document_check.h"

#include "bakerd/map/document_uri.h"
#include "bakerd/map/file_source.h"
#include "bakerd/map/json_checker.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace drtv::map {
namespace {

// Deeper nesting has no use in glTF and would overflow recursive readers.
constexpr int max_depth = 64;

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

// Not by the parser's callback: with one, it walks all siblings of each object that ends.
bool nested_deeper(std::string_view json, int levels) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t n = 0; n < json.size(); ++n) {
        const char c = json[n];
        if (in_string && c == '\\')
            ++n;
        else if (c == '"')
            in_string = !in_string;
        else if (!in_string && (c == '{' || c == '[') && ++depth > levels)
            return true;
        else if (!in_string && (c == '}' || c == ']'))
            --depth;
    }
    return false;
}

Failure check_extensions(const Json& root) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        const auto found = root.find(list);
        if (found == root.end())
            continue;
        if (!found->is_array())
            return fmt::format("{} must be an array", list);
        for (const Json& name : *found) {
            if (!name.is_string())
                return fmt::format("{} must hold strings, it holds {}", list, shown(name));
            if (std::string_view(list) == "extensionsUsed")
                continue;
            const std::string text = name.get<std::string>();
            if (std::ranges::find(supported_extensions, text) == supported_extensions.end())
                return fmt::format("it requires the extension {}, which is not supported", text);
        }
    }
    return {};
}

Failure check_asset(const Checker& check, Json& root) {
    const auto asset = root.find("asset");
    if (asset == root.end())
        return "it has no asset: not a glTF 2.0 file";
    if (Failure failure = check.properties(
            *asset, "asset", {{"version", Type::string, true}, {"minVersion", Type::string}}))
        return failure;
    const std::string version = (*asset)["version"].get<std::string>();
    if (!version.starts_with("2."))
        return fmt::format("it is glTF version {}, only 2.x is supported", shown((*asset)["version"]));
    const auto minimum = asset->find("minVersion");
    if (minimum != asset->end() && minimum->get<std::string>() != "2.0")
        return fmt::format("it needs glTF version {}, only 2.0 is supported", shown(*minimum));
    return {};
}

// The extension of this name on an element, or nullptr. REQUIRES: `extensions` was checked to be an object.
Json* extension_of(Json& element, const char* name) {
    const auto extensions = element.find("extensions");
    if (extensions == element.end())
        return nullptr;
    const auto found = extensions->find(name);
    return found == extensions->end() ? nullptr : &*found;
}

Failure check_component_type(const Json& element, const std::string& where) {
    constexpr std::array known = {5120, 5121, 5122, 5123, 5125, 5126};
    const int type = element["componentType"].get<int>();
    if (std::ranges::find(known, type) == known.end())
        return fmt::format("{}: component type {} is unknown", where, type);
    return {};
}

Failure check_accessor(const Checker& check, Json& accessor, const std::string& where) {
    if (Failure failure = check.properties(accessor,
                                           where,
                                           {{"bufferView", Type::index, false, 0, "bufferViews"},
                                            {"byteOffset", Type::count},
                                            {"componentType", Type::index, true},
                                            {"normalized", Type::boolean},
                                            {"count", Type::count, true},
                                            {"type", Type::string, true},
                                            {"sparse", Type::object}})) {
        return failure;
    }
    if (Failure failure = check_component_type(accessor, where))
        return failure;
    constexpr std::array<std::string_view, 7> types = {
        "SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
    if (std::ranges::find(types, accessor["type"].get_ref<const std::string&>()) == types.end())
        return fmt::format("{}: type {} is unknown", where, shown(accessor["type"]));
    const auto sparse = accessor.find("sparse");
    if (sparse == accessor.end())
        return {};
    const std::string sparse_where = where + " sparse";
    // tinygltf keeps these sizes in 32 bits.
    if (Failure failure = check.properties(
            *sparse,
            sparse_where,
            {{"count", Type::index, true}, {"indices", Type::object, true}, {"values", Type::object, true}}))
        return failure;
    Json& indices = (*sparse)["indices"];
    if (Failure failure = check.properties(indices,
                                           sparse_where + " indices",
                                           {{"bufferView", Type::index, true, 0, "bufferViews"},
                                            {"byteOffset", Type::index},
                                            {"componentType", Type::index, true}})) {
        return failure;
    }
    if (Failure failure = check_component_type(indices, sparse_where + " indices"))
        return failure;
    return check.properties(
        (*sparse)["values"],
        sparse_where + " values",
        {{"bufferView", Type::index, true, 0, "bufferViews"}, {"byteOffset", Type::index}});
}

// Some files use a compression without requiring it, and have nothing else: their accessors would read as
// zeros.
Failure check_compression(const Checker& check, Json& primitive, const std::string& where) {
    constexpr const char* draco = "KHR_draco_mesh_compression";
    if (extension_of(primitive, draco) == nullptr)
        return {};
    const Json& attributes = primitive["attributes"];
    if (attributes.contains("POSITION") &&
        check.element("accessors", attributes["POSITION"]).contains("bufferView"))
        return {};
    return fmt::format("{} is compressed by {}, which is not supported", where, draco);
}

Failure check_mesh(const Checker& check, Json& mesh, const std::string& where) {
    if (!mesh.is_object())
        return fmt::format("{} is not an object", where);
    const auto primitives = mesh.find("primitives");
    if (primitives == mesh.end() || !primitives->is_array())
        return fmt::format("{}: primitives must be an array", where);
    for (std::size_t n = 0; n < primitives->size(); ++n) {
        Json& primitive = (*primitives)[n];
        const std::string inner = fmt::format("{}, primitive {}", where, n);
        if (Failure failure = check.properties(primitive,
                                               inner,
                                               {{"attributes", Type::object, true},
                                                {"indices", Type::index, false, 0, "accessors"},
                                                {"material", Type::index, false, 0, "materials"},
                                                {"mode", Type::index},
                                                {"extensions", Type::object}})) {
            return failure;
        }
        if (Failure failure = check.accessors_of(primitive["attributes"], inner))
            return failure;
        if (Failure failure = check_compression(check, primitive, inner))
            return failure;
        if (primitive.contains("indices") &&
            !check.element("accessors", primitive["indices"]).contains("bufferView")) {
            return fmt::format(
                "{}: its indices, accessor {}, have no bufferView", inner, shown(primitive["indices"]));
        }
        primitive.erase("targets");
    }
    return {};
}

Failure check_texture(const Checker& check, Json& owner, const char* name, const std::string& where) {
    const auto texture = owner.find(name);
    if (texture == owner.end())
        return {};
    if (Failure failure = check.properties(*texture,
                                           where + " " + name,
                                           {{"index", Type::index, true, 0, "textures"},
                                            {"texCoord", Type::index},
                                            {"extensions", Type::object}})) {
        return failure;
    }
    Json* transform = extension_of(*texture, "KHR_texture_transform");
    if (transform == nullptr)
        return {};
    return check.properties(*transform,
                            where + ": KHR_texture_transform",
                            {{"offset", Type::number_array, false, 2},
                             {"scale", Type::number_array, false, 2},
                             {"rotation", Type::number},
                             {"texCoord", Type::index}});
}

Failure check_material(const Checker& check, Json& material, const std::string& where) {
    if (Failure failure = check.properties(material,
                                           where,
                                           {{"pbrMetallicRoughness", Type::object},
                                            {"alphaMode", Type::string},
                                            {"alphaCutoff", Type::number},
                                            {"doubleSided", Type::boolean},
                                            {"emissiveFactor", Type::number_array, false, 3},
                                            {"emissiveTexture", Type::object},
                                            {"extensions", Type::object}})) {
        return failure;
    }
    if (Failure failure = check_texture(check, material, "emissiveTexture", where))
        return failure;
    if (Json* strength = extension_of(material, "KHR_materials_emissive_strength")) {
        if (Failure failure = check.properties(
                *strength, where + ": KHR_materials_emissive_strength", {{"emissiveStrength", Type::number}}))
            return failure;
    }
    if (Json* transmission = extension_of(material, "KHR_materials_diffuse_transmission")) {
        if (Failure failure =
                check.properties(*transmission,
                                 where + ": KHR_materials_diffuse_transmission",
                                 {{"diffuseTransmissionFactor", Type::number},
                                  {"diffuseTransmissionColorFactor", Type::number_array, false, 3}})) {
            return failure;
        }
    }
    const auto pbr = material.find("pbrMetallicRoughness");
    if (pbr == material.end())
        return {};
    if (Failure failure = check.properties(
            *pbr,
            where,
            {{"baseColorFactor", Type::number_array, false, 4}, {"baseColorTexture", Type::object}}))
        return failure;
    return check_texture(check, *pbr, "baseColorTexture", where);
}

Failure check_lights(const Checker& check, Json& root, std::size_t& light_count) {
    Json* extension = extension_of(root, "KHR_lights_punctual");
    if (extension == nullptr)
        return {};
    if (!extension->is_object() || !extension->contains("lights") || !(*extension)["lights"].is_array())
        return "KHR_lights_punctual: lights must be an array";
    for (Json& light : (*extension)["lights"]) {
        const std::string where = fmt::format("light {}", light_count++);
        if (Failure failure = check.properties(light,
                                               where,
                                               {{"type", Type::string, true},
                                                {"color", Type::number_array, false, 3},
                                                {"intensity", Type::number},
                                                {"range", Type::number}})) {
            return failure;
        }
        if (light["type"] != "spot")
            continue;
        if (Failure failure = check.properties(light, where, {{"spot", Type::object, true}}))
            return failure;
        if (Failure failure =
                check.properties(light["spot"],
                                 where + " spot",
                                 {{"innerConeAngle", Type::number}, {"outerConeAngle", Type::number}}))
            return failure;
    }
    return {};
}

Failure check_node(const Checker& check, std::size_t light_count, Json& node, const std::string& where) {
    if (Failure failure = check.properties(node,
                                           where,
                                           {{"children", Type::index_array, false, 0, "nodes"},
                                            {"mesh", Type::index, false, 0, "meshes"},
                                            {"matrix", Type::number_array, false, 16},
                                            {"translation", Type::number_array, false, 3},
                                            {"rotation", Type::number_array, false, 4},
                                            {"scale", Type::number_array, false, 3},
                                            {"name", Type::string},
                                            {"extensions", Type::object}})) {
        return failure;
    }
    if (node.contains("matrix") &&
        (node.contains("translation") || node.contains("rotation") || node.contains("scale"))) {
        return fmt::format("{} has both a matrix and a translation, rotation or scale", where);
    }
    if (Json* light = extension_of(node, "KHR_lights_punctual")) {
        const std::string inner = where + ": KHR_lights_punctual";
        if (Failure failure = check.properties(*light, inner, {{"light", Type::index, true}}))
            return failure;
        if ((*light)["light"].get<std::size_t>() >= light_count)
            return fmt::format(
                "{} names light {}, the file has {}", inner, shown((*light)["light"]), light_count);
    }
    if (Json* instancing = extension_of(node, "EXT_mesh_gpu_instancing")) {
        const std::string inner = where + ": EXT_mesh_gpu_instancing";
        if (Failure failure = check.properties(*instancing, inner, {{"attributes", Type::object, true}}))
            return failure;
        if (Failure failure = check.accessors_of((*instancing)["attributes"], inner))
            return failure;
    }
    return {};
}

// Each node has at most one parent, no path leads back, and a scene holds each of its roots once: then every
// walk over children ends, and meets no node twice.
Failure check_node_tree(const Json& root) {
    const auto nodes = root.find("nodes");
    if (nodes == root.end())
        return {};
    std::vector<std::size_t> parent(nodes->size(), SIZE_MAX);
    for (std::size_t n = 0; n < nodes->size(); ++n) {
        const auto children = (*nodes)[n].find("children");
        if (children == (*nodes)[n].end())
            continue;
        for (const Json& child : *children) {
            const auto c = child.get<std::size_t>();
            if (parent[c] != SIZE_MAX)
                return fmt::format("node {} has two parents, {} and {}", c, parent[c], n);
            parent[c] = n;
        }
    }
    // 0: not seen, else the walk that saw it first; meeting one's own walk again is a cycle.
    std::vector<std::size_t> seen_in(nodes->size(), 0);
    for (std::size_t n = 0; n < nodes->size(); ++n) {
        for (std::size_t at = n; at != SIZE_MAX && seen_in[at] == 0; at = parent[at]) {
            seen_in[at] = n + 1;
            if (parent[at] != SIZE_MAX && seen_in[parent[at]] == n + 1)
                return fmt::format("node {} is its own ancestor: the node graph has a cycle", parent[at]);
        }
    }
    if (!root.contains("scenes"))
        return {};
    std::vector<std::size_t> root_of(nodes->size(), 0);  // scene + 1
    std::size_t scene_number = 0;
    for (const Json& scene : root["scenes"]) {
        ++scene_number;
        if (!scene.contains("nodes"))
            continue;
        for (const Json& node : scene["nodes"]) {
            const auto n = node.get<std::size_t>();
            if (parent[n] != SIZE_MAX)
                return fmt::format("scene {}: node {} is not a root, it is a child of node {}",
                                   scene_number - 1,
                                   n,
                                   parent[n]);
            if (root_of[n] == scene_number)
                return fmt::format("scene {}: node {} stands there twice", scene_number - 1, n);
            root_of[n] = scene_number;
        }
    }
    return {};
}

// What %xx decodes to may be anything; JSON and the service hold UTF-8 only.
bool is_utf8(const std::string& text) {
    return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::ignore)) == text;
}

// A uri becomes what tinygltf shall read: plain base64, or a place in `outside`.
Failure check_uri(Json& element,
                  const std::string& where,
                  std::optional<std::size_t> size_bytes,
                  std::vector<OutsideBytes>& outside) {
    const std::string uri = element["uri"].get<std::string>();
    if (is_data_uri(uri)) {
        auto plain = plain_data_uri(uri, size_bytes);
        if (!plain)
            return fmt::format("{}: {}", where, plain.error());
        element["uri"] = std::move(*plain);
        return {};
    }
    std::optional<std::string> path = decode_uri(uri);
    if (!path || !is_utf8(*path))
        return fmt::format("{}: the uri {} is not valid", where, shown(uri));
    if (const auto problem = path_problem(*path))
        return fmt::format("{}: {}", where, *problem);
    element["uri"] = std::to_string(outside.size());
    element["name"] = *path;
    outside.push_back({where, std::move(path), size_bytes});
    return {};
}

Failure check_buffer(const Checker& check,
                     Json& buffer,
                     const std::string& where,
                     std::vector<OutsideBytes>& outside) {
    if (Failure failure =
            check.properties(buffer, where, {{"byteLength", Type::count, true}, {"uri", Type::string}}))
        return failure;
    const auto size_bytes = buffer["byteLength"].get<std::size_t>();
    if (size_bytes == 0 || size_bytes > max_file_bytes)
        return fmt::format(
            "{}: byteLength {} does not lie between 1 and {}", where, size_bytes, max_file_bytes);
    if (buffer.contains("uri"))
        return check_uri(buffer, where, size_bytes, outside);
    if (where != "buffer 0")
        return fmt::format("{} has no uri", where);
    buffer["uri"] = std::to_string(outside.size());
    outside.push_back({where, std::nullopt, size_bytes});
    return {};
}

Failure check_buffer_view(const Checker& check, Json& view, const std::string& where) {
    if (Failure failure = check.properties(view,
                                           where,
                                           {{"buffer", Type::index, true, 0, "buffers"},
                                            {"byteOffset", Type::count},
                                            {"byteLength", Type::count, true},
                                            {"byteStride", Type::count}})) {
        return failure;
    }
    const auto end = view.value("byteOffset", std::size_t{0}) + view["byteLength"].get<std::size_t>();
    const auto buffer_bytes = check.element("buffers", view["buffer"])["byteLength"].get<std::size_t>();
    if (end > buffer_bytes)
        return fmt::format(
            "{} ends at {}, buffer {} has {} bytes", where, end, shown(view["buffer"]), buffer_bytes);
    const auto stride = view.value("byteStride", std::size_t{4});
    if (stride % 4 != 0 || stride > 252)
        return fmt::format("{}: byteStride {} is not a multiple of 4 up to 252", where, stride);
    return {};
}

Failure check_image(const Checker& check,
                    Json& image,
                    const std::string& where,
                    std::vector<OutsideBytes>& outside) {
    if (Failure failure = check.properties(image,
                                           where,
                                           {{"uri", Type::string},
                                            {"bufferView", Type::index, false, 0, "bufferViews"},
                                            {"mimeType", Type::string}}))
        return failure;
    if (image.contains("uri") == image.contains("bufferView"))
        return fmt::format("{} must have either a uri or a bufferView", where);
    if (image.contains("uri"))
        return check_uri(image, where, std::nullopt, outside);
    if (check.element("bufferViews", image["bufferView"])["byteLength"] == 0)
        return fmt::format("{}: bufferView {} is empty", where, shown(image["bufferView"]));
    return {};
}

Failure check_all(Json& root, std::vector<OutsideBytes>& outside) {
    if (!root.is_object())
        return "its JSON is not an object";
    const Checker check(root);
    if (Failure f = check_asset(check, root))
        return f;
    if (Failure f = check_extensions(root))
        return f;
    if (Failure f = check.properties(
            root, "the file", {{"scene", Type::index, false, 0, "scenes"}, {"extensions", Type::object}}))
        return f;
    if (Failure f = check.each("buffers", "buffer", [&](Json& b, const std::string& where) {
            return check_buffer(check, b, where, outside);
        }))
        return f;
    if (Failure f = check.each("bufferViews", "bufferView", [&](Json& v, const std::string& where) {
            return check_buffer_view(check, v, where);
        }))
        return f;
    if (Failure f = check.each("images", "image", [&](Json& i, const std::string& where) {
            return check_image(check, i, where, outside);
        }))
        return f;
    if (Failure f = check.each("accessors", "accessor", [&](Json& a, const std::string& where) {
            return check_accessor(check, a, where);
        }))
        return f;
    if (Failure f = check.each("samplers", "sampler", [&](Json& s, const std::string& where) {
            return check.properties(s, where, {{"wrapS", Type::index}, {"wrapT", Type::index}});
        }))
        return f;
    if (Failure f = check.each("textures", "texture", [&](Json& t, const std::string& where) {
            return check.properties(t,
                                    where,
                                    {{"source", Type::index, false, 0, "images"},
                                     {"sampler", Type::index, false, 0, "samplers"}});
        })) {
        return f;
    }
    if (Failure f = check.each("materials", "material", [&](Json& m, const std::string& where) {
            return check_material(check, m, where);
        }))
        return f;
    if (Failure f = check.each(
            "meshes", "mesh", [&](Json& m, const std::string& where) { return check_mesh(check, m, where); }))
        return f;
    std::size_t light_count = 0;
    if (Failure f = check_lights(check, root, light_count))
        return f;
    if (Failure f = check.each("nodes", "node", [&](Json& n, const std::string& where) {
            return check_node(check, light_count, n, where);
        }))
        return f;
    if (Failure f = check.each("scenes", "scene", [&](Json& s, const std::string& where) {
            return check.properties(
                s, where, {{"nodes", Type::index_array, false, 0, "nodes"}, {"name", Type::string}});
        })) {
        return f;
    }
    return check_node_tree(root);
}

}  // namespace

tl::expected<CheckedDocument, std::string> check_document(std::string_view json) {
    if (nested_deeper(json, max_depth))
        return tl::unexpected(fmt::format("its JSON is nested deeper than {} levels", max_depth));
    Json root = Json::parse(json.begin(), json.end(), nullptr, false);
    if (root.is_discarded())
        return tl::unexpected(std::string("it is not glTF: its JSON cannot be parsed"));
    CheckedDocument checked;
    if (Failure failure = check_all(root, checked.outside))
        return tl::unexpected(*failure);
    for (const char* unneeded : {"animations", "skins", "cameras"})
        root.erase(unneeded);
    checked.json = root.dump();
    return checked;
}

}  // namespace drtv::map
