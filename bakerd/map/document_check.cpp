#include "bakerd/map/document_check.h"

#include "bakerd/map/accessor_check.h"
#include "bakerd/map/extension_check.h"
#include "bakerd/map/json_checker.h"
#include "bakerd/map/json_text.h"
#include "bakerd/map/material_check.h"
#include "bakerd/map/mesh_check.h"
#include "bakerd/map/node_check.h"
#include "bakerd/map/node_tree_check.h"

#include <fmt/format.h>

namespace drtv::map {
namespace {

// Deeper nesting has no use in glTF and would overflow recursive readers.
constexpr int max_depth = 64;

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

CheckResult check_asset(const Checker& check, Json& root) {
    const auto asset = root.find("asset");
    if (asset == root.end())
        return wrong("it has no asset: not a glTF 2.0 file");
    const std::initializer_list<Property> members = {required(string_at("version")), string_at("minVersion")};
    if (CheckResult checked = check.properties(*asset, "asset", members); !checked)
        return checked;
    const Json& version = (*asset)["version"];
    if (!version.get<std::string>().starts_with("2."))
        return wrong("it is glTF version {}, only 2.x is supported", shown(version));
    const auto minimum = asset->find("minVersion");
    if (minimum != asset->end() && minimum->get<std::string>() != "2.0")
        return wrong("it needs glTF version {}, only 2.0 is supported", shown(*minimum));
    return {};
}

// Each kind of element before those that name it.
CheckResult check_all(Json& root, const std::string& path, std::vector<OutsideBytes>& outside) {
    if (!root.is_object())
        return wrong("its JSON is not an object");
    const Checker check(root);
    if (CheckResult checked = check_asset(check, root); !checked)
        return checked;
    if (CheckResult checked = check_extensions(root); !checked)
        return checked;
    const std::initializer_list<Property> members = {reference_at("scene", "scenes"),
                                                     object_at("extensions")};
    if (CheckResult checked = check.properties(root, "the file", members); !checked)
        return checked;
    if (CheckResult checked = check_buffers(check, path, outside); !checked)
        return checked;
    if (CheckResult checked = check_accessors(check); !checked)
        return checked;
    if (CheckResult checked = check_materials(check); !checked)
        return checked;
    if (CheckResult checked = check_meshes(check); !checked)
        return checked;
    if (CheckResult checked = check_nodes(check, root); !checked)
        return checked;
    return check_node_tree(root);
}

}  // namespace

tl::expected<CheckedDocument, std::string> check_document(std::string_view json, const std::string& path) {
    if (nested_deeper(json, max_depth))
        return tl::unexpected(fmt::format("its JSON is nested deeper than {} levels", max_depth));
    auto parsed = parse_json<Json>(json);
    if (!parsed)
        return tl::unexpected("it is not glTF: its JSON " + parsed.error());
    Json& root = *parsed;
    CheckedDocument checked;
    if (CheckResult all = check_all(root, path, checked.outside); !all)
        return tl::unexpected(all.error());
    for (const char* unneeded : {"animations", "cameras"})
        root.erase(unneeded);
    checked.json = root.dump();
    return checked;
}

}  // namespace drtv::map
