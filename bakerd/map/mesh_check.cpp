#include "bakerd/map/mesh_check.h"

#include "bakerd/map/extension_check.h"

namespace drtv::map {
namespace {

bool has_buffer_view(const Checker& check, const Json& accessor_index) {
    return check.element("accessors", accessor_index).contains("bufferView");
}

// Some files use a compression without requiring it, and have nothing else: their accessors would read as
// zeros.
CheckResult check_compression(const Checker& check, Json& primitive, const std::string& where) {
    constexpr const char* draco = "KHR_draco_mesh_compression";
    if (extension_of(primitive, draco) == nullptr)
        return {};
    const Json& attributes = primitive["attributes"];
    if (attributes.contains("POSITION") && has_buffer_view(check, attributes["POSITION"]))
        return {};
    return wrong("{} is compressed by {}, which is not supported", where, draco);
}

CheckResult check_primitive(const Checker& check, Json& primitive, const std::string& where) {
    const std::initializer_list<Property> members = {required(object_at("attributes")),
                                                     reference_at("indices", "accessors"),
                                                     reference_at("material", "materials"),
                                                     index_at("mode"),
                                                     object_at("extensions")};
    if (CheckResult checked = check.properties(primitive, where, members); !checked)
        return checked;
    if (CheckResult checked = check.accessors_of(primitive["attributes"], where); !checked)
        return checked;
    if (CheckResult checked = check_compression(check, primitive, where); !checked)
        return checked;
    const auto indices = primitive.find("indices");
    if (indices != primitive.end() && !has_buffer_view(check, *indices))
        return wrong("{}: its indices, accessor {}, have no bufferView", where, shown(*indices));
    primitive.erase("targets");
    return {};
}

CheckResult check_mesh(const Checker& check, Json& mesh, const std::string& where) {
    if (!mesh.is_object())
        return wrong("{} is not an object", where);
    const auto primitives = mesh.find("primitives");
    if (primitives == mesh.end() || !primitives->is_array())
        return wrong("{}: primitives must be an array", where);
    for (std::size_t n = 0; n < primitives->size(); ++n) {
        const std::string inner = fmt::format("{}, primitive {}", where, n);
        if (CheckResult checked = check_primitive(check, (*primitives)[n], inner); !checked)
            return checked;
    }
    return {};
}

}  // namespace

CheckResult check_meshes(const Checker& check) {
    return check.each("meshes", "mesh", [&](Json& mesh, const std::string& where) {
        return check_mesh(check, mesh, where);
    });
}

}  // namespace drtv::map
