#include "bakerd/map/accessor_check.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace drtv::map {
namespace {

constexpr std::array component_types = {5120, 5121, 5122, 5123, 5125, 5126};
constexpr std::array<std::string_view, 7> element_types = {
    "SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};

CheckResult check_component_type(const Json& element, const std::string& where) {
    const int type = element["componentType"].get<int>();
    if (std::ranges::find(component_types, type) == component_types.end())
        return wrong("{}: component type {} is unknown", where, type);
    return {};
}

CheckResult check_sparse(const Checker& check, Json& sparse, const std::string& where) {
    // tinygltf keeps these sizes in 32 bits.
    const std::initializer_list<Property> members = {
        required(index_at("count")), required(object_at("indices")), required(object_at("values"))};
    if (CheckResult checked = check.properties(sparse, where, members); !checked)
        return checked;
    Json& indices = sparse["indices"];
    const std::string indices_where = where + " indices";
    const std::initializer_list<Property> index_members = {
        required(reference_at("bufferView", "bufferViews")),
        index_at("byteOffset"),
        required(index_at("componentType"))};
    if (CheckResult checked = check.properties(indices, indices_where, index_members); !checked)
        return checked;
    if (CheckResult checked = check_component_type(indices, indices_where); !checked)
        return checked;
    return check.properties(sparse["values"],
                            where + " values",
                            {required(reference_at("bufferView", "bufferViews")), index_at("byteOffset")});
}

CheckResult check_accessor(const Checker& check, Json& accessor, const std::string& where) {
    const std::initializer_list<Property> members = {reference_at("bufferView", "bufferViews"),
                                                     size_at("byteOffset"),
                                                     required(index_at("componentType")),
                                                     boolean_at("normalized"),
                                                     required(size_at("count")),
                                                     required(string_at("type")),
                                                     object_at("sparse")};
    if (CheckResult checked = check.properties(accessor, where, members); !checked)
        return checked;
    if (CheckResult checked = check_component_type(accessor, where); !checked)
        return checked;
    const auto& type = accessor["type"].get_ref<const std::string&>();
    if (std::ranges::find(element_types, type) == element_types.end())
        return wrong("{}: type {} is unknown", where, shown(accessor["type"]));
    const auto sparse = accessor.find("sparse");
    if (sparse == accessor.end())
        return {};
    return check_sparse(check, *sparse, where + " sparse");
}

}  // namespace

CheckResult check_accessors(const Checker& check) {
    return check.each("accessors", "accessor", [&](Json& accessor, const std::string& where) {
        return check_accessor(check, accessor, where);
    });
}

}  // namespace drtv::map
