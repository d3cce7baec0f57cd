#include "bakerd/map/document_check.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <optional>
#include <set>

namespace drtv::map {
namespace {

using Json = nlohmann::json;
using Failure = std::optional<std::string>;  // nothing: fine

// Deeper nesting has no use in glTF and would overflow recursive readers.
constexpr int max_depth = 64;

constexpr std::array supported_extensions = {
    "EXT_mesh_gpu_instancing",     "KHR_lights_punctual",           "KHR_materials_anisotropy",   "KHR_materials_clearcoat",
    "KHR_materials_dispersion",    "KHR_materials_emissive_strength", "KHR_materials_ior",        "KHR_materials_iridescence",
    "KHR_materials_sheen",         "KHR_materials_specular",        "KHR_materials_unlit",        "KHR_materials_variants",
    "KHR_mesh_quantization",       "KHR_texture_transform",         "KHR_animation_pointer",      "KHR_xmp_json_ld"};

enum class Type { number, index, count, string, boolean, object, index_array, number_array };

bool is_index(const Json& v) {
    // Whole numbers only; as the specification allows, 3.0 is one.
    if (v.is_number_integer()) return v.is_number_unsigned() ? v.get<std::uint64_t>() <= INT32_MAX : v.get<std::int64_t>() >= 0;
    return v.is_number_float() && v.get<double>() >= 0 && v.get<double>() <= INT32_MAX && v.get<double>() == static_cast<double>(static_cast<std::int64_t>(v.get<double>()));
}

bool has_type(const Json& v, Type type) {
    switch (type) {
        case Type::number: return v.is_number();
        case Type::index: return is_index(v);
        case Type::count: return v.is_number_integer() && v.is_number_unsigned() && v.get<std::uint64_t>() < (std::uint64_t{1} << 40);
        case Type::string: return v.is_string();
        case Type::boolean: return v.is_boolean();
        case Type::object: return v.is_object();
        case Type::index_array:
        case Type::number_array:
            if (!v.is_array()) return false;
            for (const Json& element : v) {
                if (!has_type(element, type == Type::index_array ? Type::index : Type::number)) return false;
            }
            return true;
    }
    return false;
}

std::string_view name_of(Type type) {
    switch (type) {
        case Type::number: return "a number";
        case Type::index: return "an index";
        case Type::count: return "a size of at most 2^40";
        case Type::string: return "a string";
        case Type::boolean: return "true or false";
        case Type::object: return "an object";
        case Type::index_array: return "an array of indices";
        case Type::number_array: return "an array of numbers";
    }
    return "";
}

struct Property {
    const char* name;
    Type type;
    bool required = false;
    std::size_t length = 0;           // arrays: exact number of elements, 0: any
    const char* refers_to = nullptr;  // index or index_array: the top-level array it points into
};

// A short form of the value for a message.
std::string shown(const Json& value) {
    std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() > 40) text = text.substr(0, 37) + "...";
    return text;
}

class Checker {
  public:
    explicit Checker(const Json& root) : root_(root) {}

    [[nodiscard]] Failure properties(const Json& object, const std::string& where, std::initializer_list<Property> properties) const {
        if (!object.is_object()) return fmt::format("{} is not an object", where);
        for (const Property& p : properties) {
            const auto found = object.find(p.name);
            if (found == object.end()) {
                if (p.required) return fmt::format("{} has no {}", where, p.name);
                continue;
            }
            if (!has_type(*found, p.type)) return fmt::format("{}: {} must be {}, it is {}", where, p.name, name_of(p.type), shown(*found));
            if (p.length != 0 && found->size() != p.length) {
                return fmt::format("{}: {} must have {} elements, it has {}", where, p.name, p.length, found->size());
            }
            if (p.refers_to != nullptr) {
                if (Failure failure = references(*found, fmt::format("{}: {}", where, p.name), p.refers_to)) return failure;
            }
        }
        return {};
    }

    // Runs `check(element, "node 3")` over a top-level array.
    template <class Check>
    [[nodiscard]] Failure each(const char* array, const char* singular, Check check) const {
        const auto found = root_.find(array);
        if (found == root_.end()) return {};
        if (!found->is_array()) return fmt::format("{} must be an array", array);
        for (std::size_t n = 0; n < found->size(); ++n) {
            if (Failure failure = check((*found)[n], fmt::format("{} {}", singular, n))) return failure;
        }
        return {};
    }

    [[nodiscard]] std::size_t size_of(const char* array) const {
        const auto found = root_.find(array);
        return found != root_.end() && found->is_array() ? found->size() : 0;
    }

  private:
    [[nodiscard]] Failure references(const Json& value, const std::string& where, const char* array) const {
        const std::size_t size = size_of(array);
        const auto check = [&](const Json& index) -> Failure {
            if (index.get<double>() < static_cast<double>(size)) return {};
            return fmt::format("{} names {} {}, the file has {}", where, array, shown(index), size);
        };
        if (!value.is_array()) return check(value);
        for (const Json& index : value) {
            if (Failure failure = check(index)) return failure;
        }
        return {};
    }

    const Json& root_;
};

Failure check_extensions(const Json& root) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        const auto found = root.find(list);
        if (found == root.end()) continue;
        if (!found->is_array()) return fmt::format("{} must be an array", list);
        for (const Json& name : *found) {
            if (!name.is_string()) return fmt::format("{} must hold strings, it holds {}", list, shown(name));
            if (std::string_view(list) == "extensionsUsed") continue;
            const std::string text = name.get<std::string>();
            bool known = false;
            for (const char* supported : supported_extensions) known = known || text == supported;
            if (!known) return fmt::format("it requires the extension {}, which is not supported", text);
        }
    }
    return {};
}

Failure check_asset(const Checker& check, const Json& root) {
    const auto asset = root.find("asset");
    if (asset == root.end()) return "it has no asset: not a glTF 2.0 file";
    if (Failure failure = check.properties(*asset, "asset", {{"version", Type::string, true}, {"minVersion", Type::string}})) return failure;
    const std::string version = (*asset)["version"].get<std::string>();
    if (!version.starts_with("2.")) return fmt::format("it is glTF version {}, only 2.x is supported", shown((*asset)["version"]));
    const auto minimum = asset->find("minVersion");
    if (minimum != asset->end() && minimum->get<std::string>() != "2.0") return fmt::format("it needs glTF version {}, only 2.0 is supported", shown(*minimum));
    return {};
}

Failure check_accessor(const Checker& check, const Json& accessor, const std::string& where) {
    if (Failure failure = check.properties(accessor, where,
                                           {{"bufferView", Type::index, false, 0, "bufferViews"},
                                            {"byteOffset", Type::count},
                                            {"componentType", Type::index, true},
                                            {"normalized", Type::boolean},
                                            {"count", Type::count, true},
                                            {"type", Type::string, true},
                                            {"sparse", Type::object}})) {
        return failure;
    }
    const auto sparse = accessor.find("sparse");
    if (sparse == accessor.end()) return {};
    const std::string sparse_where = where + " sparse";
    if (Failure failure = check.properties(*sparse, sparse_where, {{"count", Type::count, true}, {"indices", Type::object, true}, {"values", Type::object, true}})) return failure;
    if (Failure failure = check.properties((*sparse)["indices"], sparse_where + " indices",
                                           {{"bufferView", Type::index, true, 0, "bufferViews"}, {"byteOffset", Type::count}, {"componentType", Type::index, true}})) {
        return failure;
    }
    return check.properties((*sparse)["values"], sparse_where + " values", {{"bufferView", Type::index, true, 0, "bufferViews"}, {"byteOffset", Type::count}});
}

Failure check_mesh(const Checker& check, const Json& mesh, const std::string& where) {
    if (!mesh.is_object()) return fmt::format("{} is not an object", where);
    const auto primitives = mesh.find("primitives");
    if (primitives == mesh.end() || !primitives->is_array()) return fmt::format("{}: primitives must be an array", where);
    for (std::size_t n = 0; n < primitives->size(); ++n) {
        const Json& primitive = (*primitives)[n];
        const std::string inner = fmt::format("{}, primitive {}", where, n);
        if (Failure failure = check.properties(primitive, inner,
                                               {{"attributes", Type::object, true},
                                                {"indices", Type::index, false, 0, "accessors"},
                                                {"material", Type::index, false, 0, "materials"},
                                                {"mode", Type::index}})) {
            return failure;
        }
        for (const auto& [name, accessor] : primitive["attributes"].items()) {
            if (!is_index(accessor) || accessor.get<double>() >= static_cast<double>(check.size_of("accessors"))) {
                return fmt::format("{}: attribute {} names accessor {}, the file has {}", inner, name, shown(accessor), check.size_of("accessors"));
            }
        }
    }
    return {};
}

Failure check_material(const Checker& check, const Json& material, const std::string& where) {
    if (Failure failure = check.properties(material, where,
                                           {{"pbrMetallicRoughness", Type::object}, {"alphaMode", Type::string}, {"alphaCutoff", Type::number}, {"doubleSided", Type::boolean}})) {
        return failure;
    }
    const auto pbr = material.find("pbrMetallicRoughness");
    if (pbr == material.end()) return {};
    if (Failure failure = check.properties(*pbr, where, {{"baseColorFactor", Type::number_array, false, 4}, {"baseColorTexture", Type::object}})) return failure;
    const auto texture = pbr->find("baseColorTexture");
    if (texture == pbr->end()) return {};
    return check.properties(*texture, where + " baseColorTexture", {{"index", Type::index, true, 0, "textures"}, {"texCoord", Type::index}, {"extensions", Type::object}});
}

Failure check_node(const Checker& check, const Json& node, const std::string& where) {
    return check.properties(node, where,
                            {{"children", Type::index_array, false, 0, "nodes"},
                             {"mesh", Type::index, false, 0, "meshes"},
                             {"matrix", Type::number_array, false, 16},
                             {"translation", Type::number_array, false, 3},
                             {"rotation", Type::number_array, false, 4},
                             {"scale", Type::number_array, false, 3},
                             {"name", Type::string}});
}

// Each node has at most one parent and no path leads back: then every walk over children ends.
Failure check_node_tree(const Json& root) {
    const auto nodes = root.find("nodes");
    if (nodes == root.end()) return {};
    std::vector<std::size_t> parent(nodes->size(), SIZE_MAX);
    for (std::size_t n = 0; n < nodes->size(); ++n) {
        const auto children = (*nodes)[n].find("children");
        if (children == (*nodes)[n].end()) continue;
        for (const Json& child : *children) {
            const auto c = static_cast<std::size_t>(child.get<double>());
            if (parent[c] != SIZE_MAX) return fmt::format("node {} has two parents, {} and {}", c, parent[c], n);
            parent[c] = n;
        }
    }
    // 0: not seen, else the walk that saw it first; meeting one's own walk again is a cycle.
    std::vector<std::size_t> seen_in(nodes->size(), 0);
    for (std::size_t n = 0; n < nodes->size(); ++n) {
        for (std::size_t at = n; at != SIZE_MAX && seen_in[at] == 0; at = parent[at]) {
            seen_in[at] = n + 1;
            if (parent[at] != SIZE_MAX && seen_in[parent[at]] == n + 1) return fmt::format("node {} is its own ancestor: the node graph has a cycle", parent[at]);
        }
    }
    return {};
}

std::optional<std::string> decode_uri(const std::string& uri) {
    std::string decoded;
    for (std::size_t n = 0; n < uri.size(); ++n) {
        if (uri[n] != '%') {
            decoded += uri[n];
            continue;
        }
        if (n + 2 >= uri.size() || !std::isxdigit(static_cast<unsigned char>(uri[n + 1])) || !std::isxdigit(static_cast<unsigned char>(uri[n + 2]))) return std::nullopt;
        decoded += static_cast<char>(std::stoi(uri.substr(n + 1, 2), nullptr, 16));
        n += 2;
    }
    return decoded;
}

// A file must lie in the document's folder or below it.
Failure check_external_path(const std::string& where, const std::string& path) {
    const bool absolute = path.starts_with("/") || path.starts_with("\\") || path.find(':') != std::string::npos;
    if (absolute) return fmt::format("{}: the path '{}' is absolute, it must lie in the map's folder", where, path);
    if (path.empty() || path.find('\0') != std::string::npos || path.find('\\') != std::string::npos) return fmt::format("{}: the path '{}' is not valid", where, path);
    for (std::size_t start = 0; start <= path.size();) {
        const std::size_t end = std::min(path.find('/', start), path.size());
        if (path.substr(start, end - start) == "..") return fmt::format("{}: the path '{}' leaves the map's folder", where, path);
        start = end + 1;
    }
    return {};
}

Failure check_uri(const Json& element, const std::string& where, std::vector<std::string>& external) {
    const auto uri = element.find("uri");
    if (uri == element.end() || uri->get_ref<const std::string&>().starts_with("data:")) return {};
    const std::optional<std::string> decoded = decode_uri(uri->get<std::string>());
    if (!decoded) return fmt::format("{}: the uri {} is not valid", where, shown(*uri));
    if (Failure failure = check_external_path(where, *decoded)) return failure;
    external.push_back(*decoded);
    return {};
}

Failure check_buffers_and_images(const Checker& check, std::vector<std::string>& external) {
    if (Failure f = check.each("buffers", "buffer", [&](const Json& buffer, const std::string& where) -> Failure {
            if (Failure failure = check.properties(buffer, where, {{"byteLength", Type::count, true}, {"uri", Type::string}})) return failure;
            return check_uri(buffer, where, external);
        })) {
        return f;
    }
    if (Failure f = check.each("bufferViews", "bufferView", [&](const Json& view, const std::string& where) {
            return check.properties(view, where, {{"buffer", Type::index, true, 0, "buffers"}, {"byteOffset", Type::count}, {"byteLength", Type::count, true}, {"byteStride", Type::count}});
        })) {
        return f;
    }
    return check.each("images", "image", [&](const Json& image, const std::string& where) -> Failure {
        if (Failure failure = check.properties(image, where, {{"uri", Type::string}, {"bufferView", Type::index, false, 0, "bufferViews"}, {"mimeType", Type::string}})) return failure;
        if (image.contains("uri") == image.contains("bufferView")) return fmt::format("{} must have either a uri or a bufferView", where);
        return check_uri(image, where, external);
    });
}

Failure check_all(const Json& root, DocumentSummary& summary) {
    if (!root.is_object()) return "its JSON is not an object";
    const Checker check(root);
    if (Failure f = check_asset(check, root)) return f;
    if (Failure f = check_extensions(root)) return f;
    if (Failure f = check.properties(root, "the file", {{"scene", Type::index, false, 0, "scenes"}})) return f;
    if (Failure f = check_buffers_and_images(check, summary.external_files)) return f;
    if (Failure f = check.each("accessors", "accessor", [&](const Json& a, const std::string& where) { return check_accessor(check, a, where); })) return f;
    if (Failure f = check.each("samplers", "sampler", [&](const Json& s, const std::string& where) { return check.properties(s, where, {{"wrapS", Type::index}, {"wrapT", Type::index}}); })) return f;
    if (Failure f = check.each("textures", "texture", [&](const Json& t, const std::string& where) {
            return check.properties(t, where, {{"source", Type::index, false, 0, "images"}, {"sampler", Type::index, false, 0, "samplers"}});
        })) {
        return f;
    }
    if (Failure f = check.each("materials", "material", [&](const Json& m, const std::string& where) { return check_material(check, m, where); })) return f;
    if (Failure f = check.each("meshes", "mesh", [&](const Json& m, const std::string& where) { return check_mesh(check, m, where); })) return f;
    if (Failure f = check.each("nodes", "node", [&](const Json& n, const std::string& where) { return check_node(check, n, where); })) return f;
    if (Failure f = check.each("scenes", "scene", [&](const Json& s, const std::string& where) {
            return check.properties(s, where, {{"nodes", Type::index_array, false, 0, "nodes"}, {"name", Type::string}});
        })) {
        return f;
    }
    return check_node_tree(root);
}

}  // namespace

tl::expected<DocumentSummary, std::string> check_document(std::string_view json) {
    bool too_deep = false;
    const auto watch_depth = [&too_deep](int depth, Json::parse_event_t, Json&) {
        too_deep = too_deep || depth > max_depth;
        return !too_deep;
    };
    const Json root = Json::parse(json.begin(), json.end(), watch_depth, false);
    if (too_deep) return tl::unexpected(fmt::format("its JSON is nested deeper than {} levels", max_depth));
    if (root.is_discarded()) return tl::unexpected(std::string("it is not glTF: its JSON cannot be parsed"));
    DocumentSummary summary;
    if (Failure failure = check_all(root, summary)) return tl::unexpected(*failure);
    return summary;
}

}  // namespace drtv::map
